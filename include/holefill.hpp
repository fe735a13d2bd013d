/* The C interface of holefill as C++17 classes: header only, nothing but holefill.h behind it.
 *
 * Meshes, plans, reports and options own their handles: they can be moved, not copied, and free themselves. What they
 * do, cost and guarantee is said at the C functions of nearly the same name.
 *
 * Errors. A function that can fail has the return type Result<T>. That is T, and failures are thrown as
 * holefill::Exception; unless HOLEFILL_NO_EXCEPTIONS is defined before the header is included: then it is
 * holefill::Expected<T>, which holds a value or a Failure, and the header compiles without exceptions. All
 * translation units of a program must agree on that macro. std::bad_alloc may be thrown besides.
 *
 * A hole that stays open is no failure of the call. Report::is_complete() and Plan::is_complete() say whether everything
 * was done that was asked for. The compiler warns when a report or a plan is not looked at.
 *
 * Callbacks may throw, from any thread: the call is stopped, the mesh stays as it was, and the exception is thrown
 * again by the call.
 *
 * Threads. As in holefill.h: an object may be read by several threads at the same time; whoever changes it must be alone.
 */
#ifndef HOLEFILL_HPP
#define HOLEFILL_HPP

#include "holefill.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#ifndef HOLEFILL_NO_EXCEPTIONS
#include <exception>
#include <stdexcept>
#endif

namespace holefill {

/* Why a call failed. */
struct Failure {
    HolefillStatus status = HOLEFILL_STATUS_OK;
    std::string message;
};

#ifndef HOLEFILL_NO_EXCEPTIONS

/* A call failed. what() is the message. */
class Exception : public std::runtime_error {
public:
    explicit Exception(const Failure& failure) : std::runtime_error(failure.message), status_(failure.status) {}
    HolefillStatus status() const noexcept { return status_; }

private:
    HolefillStatus status_;
};

template <class T>
using Result = T;

#else

/* A value, or why there is none. */
template <class T>
class Expected;

template <>
class [[nodiscard]] Expected<void> {
public:
    Expected() = default;
    Expected(Failure failure) : failure_(std::move(failure)) {}

    bool has_value() const noexcept { return failure_.status == HOLEFILL_STATUS_OK; }
    explicit operator bool() const noexcept { return has_value(); }
    /* Status HOLEFILL_STATUS_OK when there is a value. */
    const Failure& failure() const noexcept { return failure_; }

private:
    Failure failure_;
};

template <class T>
class [[nodiscard]] Expected : public Expected<void> {
public:
    Expected(T value) : value_(std::move(value)) {}
    Expected(Failure failure) : Expected<void>(std::move(failure)) {}

    /* The value. There must be one. */
    T& value() & noexcept { return *value_; }
    const T& value() const& noexcept { return *value_; }
    T&& value() && noexcept { return std::move(*value_); }
    T& operator*() & noexcept { return *value_; }
    const T& operator*() const& noexcept { return *value_; }
    T&& operator*() && noexcept { return std::move(*value_); }
    T* operator->() noexcept { return &*value_; }
    const T* operator->() const noexcept { return &*value_; }

private:
    std::optional<T> value_;
};

template <class T>
using Result = Expected<T>;

#endif

namespace detail {

/* The type of the numbers in a row. */
template <class Row>
struct Number {
    using type = Row;
};
template <class T, std::size_t N>
struct Number<std::array<T, N>> {
    using type = T;
};

template <class Row>
constexpr HolefillType scalar_type() {
    using T = typename Number<Row>::type;
    if constexpr (std::is_same_v<T, double>) {
        return HOLEFILL_TYPE_F64;
    } else if constexpr (std::is_same_v<T, float>) {
        return HOLEFILL_TYPE_F32;
    } else {
        static_assert(std::is_integral_v<T> && !std::is_same_v<T, bool>, "not a type that holefill reads");
        if constexpr (std::is_signed_v<T>) {
            return sizeof(T) == 1   ? HOLEFILL_TYPE_I8
                   : sizeof(T) == 2 ? HOLEFILL_TYPE_I16
                   : sizeof(T) == 4 ? HOLEFILL_TYPE_I32
                                    : HOLEFILL_TYPE_I64;
        } else {
            return sizeof(T) == 1   ? HOLEFILL_TYPE_U8
                   : sizeof(T) == 2 ? HOLEFILL_TYPE_U16
                   : sizeof(T) == 4 ? HOLEFILL_TYPE_U32
                                    : HOLEFILL_TYPE_U64;
        }
    }
}

/* Calls of C that end with the first that fails: those after it are left out. */
class Steps {
public:
    Steps() = default;
    Steps(const Steps&) = delete;
    Steps& operator=(const Steps&) = delete;
    ~Steps() { holefill_error_free(error_); }

    /* Calls `function(arguments..., error)`. Returns whether no call has failed. */
    template <class Function, class... Arguments>
    bool operator()(Function function, Arguments... arguments) {
        if (is_success()) {
            status_ = function(arguments..., &error_);
        }
        return is_success();
    }
    /* What `function(arguments..., &value, error)` writes. */
    template <class T, class Function, class... Arguments>
    T query(T value, Function function, Arguments... arguments) {
        (*this)(function, arguments..., &value);
        return value;
    }
    /* The `count` rows of `width` elements that `function(arguments..., &output, error)` writes. */
    template <class T, class Function, class... Arguments>
    std::vector<T> rows(uint64_t count, uint64_t width, Function function, Arguments... arguments) {
        std::vector<T> values(static_cast<std::size_t>(is_success() ? count * width : 0));
        const HolefillOutput output{values.data(), count, 0, scalar_type<T>(), 0};
        (*this)(function, arguments..., &output);
        return values;
    }
    /* The text or list that `function(arguments..., buffer, capacity, &length, error)` writes. A text needs room for one
     * more. */
    template <class List, class Function, class... Arguments>
    List list(Function function, Arguments... arguments) {
        constexpr std::size_t END = std::is_same_v<List, std::string> ? 1 : 0;
        List list;
        uint64_t length = 0;
        if ((*this)(function, arguments..., nullptr, uint64_t{0}, &length) && length > 0) {
            list.resize(static_cast<std::size_t>(length) + END);
            (*this)(function, arguments..., list.data(), uint64_t{list.size()}, &length);
            list.resize(is_success() ? static_cast<std::size_t>(length) : 0);
        }
        return list;
    }

    bool is_success() const noexcept { return status_ == HOLEFILL_STATUS_OK || status_ == HOLEFILL_STATUS_INCOMPLETE; }
    HolefillStatus status() const noexcept { return status_; }
    /* Nothing, or the failure. */
    Result<void> result() const {
        if (!is_success()) {
            return fail<void>();
        }
        return Result<void>();
    }
    /* The value, if no call has failed. */
    template <class T>
    Result<T> result(T value) const {
        if (!is_success()) {
            return fail<T>();
        }
        return value;
    }

private:
    template <class T>
    Result<T> fail() const {
        Failure failure{status_, {}};
        const HolefillError error = error_;
        Steps steps;
        failure.message = steps.list<std::string>([&](char* buffer, uint64_t capacity, uint64_t* length, HolefillError*) {
            return holefill_error_message(error, buffer, capacity, length);
        });
        if (failure.message.empty()) {
            failure.message = holefill_status_message(status_);
        }
#ifndef HOLEFILL_NO_EXCEPTIONS
        throw Exception(failure);
#else
        return failure;
#endif
    }

    HolefillStatus status_ = HOLEFILL_STATUS_OK;
    HolefillError error_{};
};

/* One step of each kind. */
template <class... Arguments>
Result<void> run(Arguments... arguments) {
    Steps call;
    call(arguments...);
    return call.result();
}
template <class T, class... Arguments>
Result<T> query(T value, Arguments... arguments) {
    Steps call;
    return call.result(call.query(std::move(value), arguments...));
}
template <class List, class... Arguments>
Result<List> list(Arguments... arguments) {
    Steps call;
    return call.result(call.template list<List>(arguments...));
}

class Call;

/* A handle that is freed with its owner. */
template <class Handle, HolefillStatus (*free_handle)(Handle)>
class Owned {
public:
    Owned() = default;
    explicit Owned(Handle handle) noexcept : handle_(handle) {}
    Owned(Owned&& other) noexcept : handle_(std::exchange(other.handle_, Handle{})) {}
    Owned& operator=(Owned&& other) noexcept {
        if (this != &other) {
            free_handle(handle_);
            handle_ = std::exchange(other.handle_, Handle{});
        }
        return *this;
    }
    ~Owned() { free_handle(handle_); }

    Handle get() const noexcept { return handle_; }
    /* The handle, which the caller frees from now on. */
    Handle release() noexcept { return std::exchange(handle_, Handle{}); }

private:
    Handle handle_{};
};

} // namespace detail

/* Rows of N numbers in the caller's memory, read during the call only. */
template <std::size_t N>
class Rows {
public:
    /* `count` rows that begin `stride` bytes apart; 0: without a gap. */
    template <class T>
    Rows(const T* data, std::size_t count, std::size_t stride = 0)
        : input_{data, count, stride, detail::scalar_type<T>(), 0} {}
    template <class T>
    Rows(const std::vector<std::array<T, N>>& rows) : Rows(rows.empty() ? nullptr : rows[0].data(), rows.size()) {}
    /* A list of single numbers, for N = 1. */
    template <class T, std::size_t M = N, std::enable_if_t<M == 1 && std::is_arithmetic_v<T>, int> = 0>
    Rows(const std::vector<T>& values) : Rows(values.data(), values.size()) {}

    const HolefillInput* get() const noexcept { return &input_; }

private:
    HolefillInput input_;
};

/* Which loops are chosen; everything that is left out chooses all. */
struct Selection {
    /* Directed boundary edges, as they run in their triangles. */
    std::vector<std::array<uint64_t, 2>> only;
    std::vector<std::array<uint64_t, 2>> keep;
    /* 0: no limit. */
    uint64_t max_edges = 0;
    double max_perimeter = 0.0;
    uint64_t keep_largest = 0;

    /* As C has it: points into this one. */
    HolefillSelection raw() const {
        HolefillSelection raw = HOLEFILL_SELECTION_INIT;
        raw.only = *Rows<2>(only).get();
        raw.keep = *Rows<2>(keep).get();
        raw.max_edges = max_edges;
        raw.max_perimeter = max_perimeter;
        raw.keep_largest = keep_largest;
        return raw;
    }
};

/* Which loops are filled or planned; every open loop if nothing is said. Rows are the caller's memory. */
class Target {
public:
    Target() = default;
    Target(Selection selection) : selection_(std::move(selection)) {}

    static Target all() { return {}; }
    static Target selected(Selection selection) { return Target(std::move(selection)); }
    static Target loop(uint64_t id) {
        Target target(HOLEFILL_TARGET_LOOP);
        target.raw_.loop_id = id;
        return target;
    }
    /* The loop through a boundary edge, as it runs in its triangle. */
    static Target edge(uint64_t from, uint64_t to) {
        Target target(HOLEFILL_TARGET_EDGE);
        target.raw_.edge[0] = from;
        target.raw_.edge[1] = to;
        return target;
    }
    /* The loops that a closed chain of vertices consists of. */
    static Target vertices(const Rows<1>& vertices) { return Target(HOLEFILL_TARGET_VERTICES, *vertices.get()); }
    static Target loops(const Rows<1>& ids) { return Target(HOLEFILL_TARGET_LOOPS, *ids.get()); }

    /* Calls `function` with the target as C has it. */
    template <class Function>
    auto with(Function function) const {
        const HolefillSelection selection = selection_.raw();
        HolefillTarget target = raw_;
        target.ids = &ids_;
        target.selection = &selection;
        return function(&target);
    }

private:
    explicit Target(HolefillTargetKind kind, const HolefillInput& ids = {}) : ids_(ids) {
        raw_.kind = kind;
    }

    HolefillTarget raw_ = HOLEFILL_TARGET_INIT;
    HolefillInput ids_ = HOLEFILL_INPUT_INIT;
    Selection selection_;
};

/* What is filled how. Parameters that have names are set with `set`; holefill_parameter_name lists them. Options can be
 * copied, and set in one expression: Options options = Options().method("flat").threads(1); */
class Options {
public:
    /* Returns false to stop. */
    using Progress = std::function<bool(const HolefillProgress&)>;
    using Log = std::function<void(HolefillLogLevel, const char*)>;

    /* `auto` if it is never called. An unknown name is a failure of the call that the options are given to. */
    Options& method(std::string name) { return method_ = std::move(name), *this; }
    Options& seed(uint64_t seed) noexcept { return raw_.seed = seed, *this; }
    /* In seconds. */
    Options& time_budget(double seconds) noexcept { return raw_.time_budget = seconds, *this; }
    Options& density(double density) noexcept { return raw_.density = density, *this; }
    Options& max_new_vertices(uint64_t count) noexcept { return raw_.max_new_vertices = count, *this; }
    /* 0: as many as there are processors; 1: the calling thread. */
    Options& threads(uint32_t count) noexcept { return raw_.threads = count, *this; }
    Options& on_progress(Progress progress) { return progress_ = std::move(progress), *this; }
    Options& on_log(Log log, HolefillLogLevel level = HOLEFILL_LOG_INFO) {
        return log_ = std::move(log), raw_.log_level = level, *this;
    }
    Result<void> set(const char* name, const char* value) {
        detail::Steps call;
        const Parameters parameters = make(call);
        if (call(holefill_parameters_set, parameters.get(), name, value)) {
            named_.emplace_back(name, value);
        }
        return call.result();
    }

private:
    friend class detail::Call;
    using Parameters = detail::Owned<HolefillParameters, holefill_parameters_free>;

    /* Makes a set of the parameters that were set. */
    Parameters make(detail::Steps& call) const {
        Parameters parameters(call.query(HolefillParameters{}, holefill_parameters_new));
        for (const auto& [name, value] : named_) {
            call(holefill_parameters_set, parameters.get(), name.c_str(), value.c_str());
        }
        return parameters;
    }

    HolefillFillOptions raw_ = HOLEFILL_FILL_OPTIONS_INIT;
    std::string method_;
    std::vector<std::pair<std::string, std::string>> named_;
    Progress progress_;
    Log log_;
};

/* How a mesh is made from points; all 0 is the default. */
struct PointOptions {
    /* The largest radius of the circle through the corners of a triangle. */
    double radius = 0.0;
    /* How many of the nearest points each point chooses its triangles from, 6 to 200. */
    uint32_t neighbours = 0;
    uint32_t threads = 0;
    /* In seconds. */
    double time_budget = 0.0;
    /* Returns false to stop. */
    Options::Progress on_progress;
};

namespace detail {

/* Hands callbacks through C, and what they throw back to the caller. */
class Callbacks {
public:
    Callbacks(const Options::Progress& progress, const Options::Log& log) : progress_(progress), log_(log) {}
    Callbacks(const Callbacks&) = delete;
    Callbacks& operator=(const Callbacks&) = delete;

    /* To be called when the C function has returned. */
    void rethrow() {
#ifndef HOLEFILL_NO_EXCEPTIONS
        if (thrown_) {
            std::rethrow_exception(thrown_);
        }
#endif
    }

    static int32_t progress(const HolefillProgress* progress, void* data) {
        Callbacks& self = *static_cast<Callbacks*>(data);
        return self.guarded([&] { return !self.progress_ || self.progress_(*progress); }) ? 0 : 1;
    }
    static void log(HolefillLogLevel level, const char* message, void* data) {
        Callbacks& self = *static_cast<Callbacks*>(data);
        self.guarded([&] { return self.log_(level, message), true; });
    }

private:
    /* What `function` returns; false when a callback has thrown. One is called at a time. */
    template <class Function>
    bool guarded(Function function) {
#ifndef HOLEFILL_NO_EXCEPTIONS
        try {
            return function() && !thrown_;
        } catch (...) {
            if (!thrown_) {
                thrown_ = std::current_exception();
            }
            return false;
        }
#else
        return function();
#endif
    }

    const Options::Progress& progress_;
    const Options::Log& log_;
#ifndef HOLEFILL_NO_EXCEPTIONS
    std::exception_ptr thrown_;
#endif
};

/* The options of one call as C has them. */
class Call : public Callbacks {
public:
    Call(const Options& options, Steps& call)
        : Callbacks(options.progress_, options.log_),
          parameters_(options.named_.empty() ? Options::Parameters() : options.make(call)), raw_(options.raw_) {
        Callbacks* callbacks = this;
        raw_.method = options.method_.empty() ? nullptr : options.method_.c_str();
        raw_.parameters = parameters_.get();
        if (options.progress_ || options.log_) {
            raw_.progress = &Callbacks::progress;
            raw_.progress_data = callbacks;
        }
        if (options.log_) {
            raw_.log = &Callbacks::log;
            raw_.log_data = callbacks;
        }
    }
    const HolefillFillOptions* raw() const noexcept { return &raw_; }

private:
    Options::Parameters parameters_;
    HolefillFillOptions raw_;
};

} // namespace detail

/* A method that was tried and not used. */
struct Attempt {
    std::string method;
    std::string reason;
};

/* What happened to one hole: the fields of HolefillHole, the texts, and the prediction if a method made one. */
struct Hole : HolefillHole {
    std::string reason;
    std::vector<Attempt> tried;
    std::optional<HolefillPrediction> prediction;
};

/* What happened to all holes of a call. */
class [[nodiscard]] Report {
public:
    explicit Report(HolefillReport handle, HolefillStatus status = HOLEFILL_STATUS_OK) noexcept
        : handle_(handle), status_(status) {}

    /* Whether every hole that was asked for is closed, or has a patch. */
    bool is_complete() const noexcept { return status_ != HOLEFILL_STATUS_INCOMPLETE; }
    Result<HolefillSummary> summary() const {
        return detail::query<HolefillSummary>(HOLEFILL_SUMMARY_INIT, holefill_report_summary, get());
    }
    /* Entry `index`, in the order of the loops' ids. */
    Result<Hole> hole(uint64_t index) const {
        detail::Steps call;
        return call.result(read_hole(index, call));
    }
    Result<std::vector<Hole>> holes() const {
        detail::Steps call;
        const auto summary = call.query<HolefillSummary>(HOLEFILL_SUMMARY_INIT, holefill_report_summary, get());
        std::vector<Hole> holes;
        for (uint64_t i = 0; i < summary.hole_count && call.is_success(); ++i) {
            holes.push_back(read_hole(i, call));
        }
        return call.result(std::move(holes));
    }
    /* Everything, as holefill_report_json says. */
    Result<std::string> json() const {
        return detail::list<std::string>(holefill_report_json, get());
    }
    HolefillReport get() const noexcept { return handle_.get(); }

private:
    Hole read_hole(uint64_t index, detail::Steps& call) const {
        Hole hole{HOLEFILL_HOLE_INIT, {}, {}, {}};
        call(holefill_report_hole, get(), index, &hole);
        hole.reason = call.list<std::string>(holefill_report_reason, get(), index);
        for (uint32_t k = 0; k < hole.tried_count && call.is_success(); ++k) {
            const char* method = nullptr;
            std::string reason = call.list<std::string>(holefill_report_tried, get(), index, k, &method);
            hole.tried.push_back({method ? method : "", std::move(reason)});
        }
        HolefillPrediction found = HOLEFILL_PREDICTION_INIT;
        /* Most methods predict nothing, which is no error. */
        if (holefill_report_prediction(get(), index, &found, nullptr) != HOLEFILL_STATUS_NOT_FOUND &&
            call(holefill_report_prediction, get(), index, &found)) {
            hole.prediction = found;
        }
        return hole;
    }

    detail::Owned<HolefillReport, holefill_report_free> handle_;
    HolefillStatus status_;
};

/* The patch for one hole. In `triangles` indices below `first_vertex` are vertices of the mesh (or of the patches
 * before it in its plan), and `first_vertex + i` is positions[i]. */
struct Patch {
    uint64_t first_vertex = 0;
    std::vector<std::array<double, 3>> positions;
    std::vector<std::array<uint64_t, 3>> triangles;
};

/* Patches for chosen holes, not yet part of the mesh. */
class [[nodiscard]] Plan {
public:
    explicit Plan(HolefillPlan handle, HolefillStatus status = HOLEFILL_STATUS_OK) noexcept
        : handle_(handle), status_(status) {}

    /* Whether every hole that was asked for has a patch. */
    bool is_complete() const noexcept { return status_ != HOLEFILL_STATUS_INCOMPLETE; }
    Result<Report> report() const {
        detail::Steps call;
        return call.result(Report(call.query(HolefillReport{}, holefill_plan_report, get()), status_));
    }
    /* The patch for a loop. Fails with HOLEFILL_STATUS_NOT_FOUND when the plan has none: its report says why. */
    Result<Patch> patch(uint64_t loop_id) const {
        detail::Steps call;
        const auto info = call.query<HolefillPatchInfo>(HOLEFILL_PATCH_INFO_INIT, holefill_plan_patch, get(), loop_id);
        return call.result(Patch{
            info.first_vertex,
            call.rows<std::array<double, 3>>(info.vertex_count, 1, holefill_plan_read_positions, get(), loop_id, 0),
            call.rows<std::array<uint64_t, 3>>(info.triangle_count, 1, holefill_plan_read_triangles, get(), loop_id, 0)});
    }
    HolefillPlan get() const noexcept { return handle_.get(); }

private:
    detail::Owned<HolefillPlan, holefill_plan_free> handle_;
    HolefillStatus status_;
};

/* An attribute of the vertices or triangles of a mesh. */
struct Attribute : HolefillAttributeInfo {
    std::string name;
};

/* A triangle mesh, or a closed polyline, and what is filled in it. */
class Mesh {
public:
    explicit Mesh(HolefillMesh handle) noexcept : handle_(handle) {}

    static Result<Mesh> from_arrays(const Rows<3>& positions, const Rows<3>& triangles) {
        return make(holefill_mesh_from_arrays, positions.get(), triangles.get());
    }
    /* The last point is joined to the first. */
    static Result<Mesh> from_polyline(const Rows<3>& points, const std::optional<Rows<3>>& normals = std::nullopt) {
        return make(holefill_mesh_from_polyline, points.get(), normals ? normals->get() : nullptr);
    }

    /* The points are the vertices. `normals` and `colors` have a row for each point, if they are there. `summary` gets
     * what became of the points, if it is not null. */
    static Result<Mesh> from_points(const Rows<3>& points, const std::optional<Rows<3>>& normals = std::nullopt,
                                    const std::optional<Rows<3>>& colors = std::nullopt,
                                    const PointOptions& options = {}, HolefillPointSummary* summary = nullptr) {
        const Options::Log no_log;
        detail::Callbacks callbacks(options.on_progress, no_log);
        HolefillPointOptions raw = HOLEFILL_POINT_OPTIONS_INIT;
        raw.radius = options.radius;
        raw.neighbours = options.neighbours;
        raw.threads = options.threads;
        raw.time_budget = options.time_budget;
        if (options.on_progress) {
            raw.progress = &detail::Callbacks::progress;
            raw.progress_data = &callbacks;
        }
        HolefillPointSummary became = HOLEFILL_POINT_SUMMARY_INIT;
        detail::Steps call;
        Mesh mesh(call.query(HolefillMesh{}, [&](HolefillMesh* made, HolefillError* error) {
            return holefill_mesh_from_points(points.get(), normals ? normals->get() : nullptr,
                                             colors ? colors->get() : nullptr, &raw, made, &became, error);
        }));
        callbacks.rethrow();
        if (summary && call.is_success()) {
            *summary = became;
        }
        return call.result(std::move(mesh));
    }

    Result<HolefillMeshInfo> info() const {
        return detail::query<HolefillMeshInfo>(HOLEFILL_MESH_INFO_INIT, holefill_mesh_info, get());
    }
    Result<HolefillDefects> defects() const {
        return detail::query<HolefillDefects>(HOLEFILL_DEFECTS_INIT, holefill_mesh_defects, get());
    }
    Result<void> prepare() const { return detail::run(holefill_mesh_prepare, get()); }
    /* The vertices from `first` on, as float or double. */
    template <class T = double>
    Result<std::vector<std::array<T, 3>>> positions(uint64_t first = 0) const {
        return read_rows<T>(first, &HolefillMeshInfo::vertex_count, holefill_mesh_read_positions);
    }
    /* The triangles from `first` on, as integers of 32 or 64 bits. */
    template <class T = uint32_t>
    Result<std::vector<std::array<T, 3>>> triangles(uint64_t first = 0) const {
        return read_rows<T>(first, &HolefillMeshInfo::triangle_count, holefill_mesh_read_triangles);
    }

    /* `values` has `components` numbers for each vertex or triangle. */
    template <class T>
    Result<void> add_attribute(HolefillElement element, const char* name, uint32_t components,
                               const std::vector<T>& values) {
        const HolefillInput input{values.data(), components == 0 ? 0 : values.size() / components, 0,
                                  detail::scalar_type<T>(), 0};
        return detail::run(holefill_mesh_add_attribute, get(), element, name, components, &input);
    }
    Result<std::vector<Attribute>> attributes(HolefillElement element) const {
        detail::Steps call;
        const uint64_t count = call.query(uint64_t{0}, holefill_mesh_attribute_count, get(), element);
        std::vector<Attribute> attributes;
        for (uint64_t i = 0; i < count && call.is_success(); ++i) {
            Attribute attribute{HOLEFILL_ATTRIBUTE_INFO_INIT, {}};
            call(holefill_mesh_attribute_info, get(), element, i, &attribute);
            attribute.name = call.list<std::string>(holefill_mesh_attribute_name, get(), element, i);
            attributes.push_back(std::move(attribute));
        }
        return call.result(std::move(attributes));
    }
    /* The values of attribute `index` from row `first` on, one row after the other, in its own type or as double. */
    template <class T = double>
    Result<std::vector<T>> attribute(HolefillElement element, uint64_t index, uint64_t first = 0) const {
        detail::Steps call;
        const auto info = call.query<HolefillAttributeInfo>(HOLEFILL_ATTRIBUTE_INFO_INIT, holefill_mesh_attribute_info,
                                                            get(), element, index);
        const uint64_t count = first < info.count ? info.count - first : 0;
        return call.result(
            call.rows<T>(count, info.components, holefill_mesh_read_attribute, get(), element, index, first));
    }

    Result<uint64_t> loop_count() const {
        return detail::query(uint64_t{0}, holefill_mesh_loop_count, get());
    }
    Result<HolefillLoopInfo> loop(uint64_t loop_id) const {
        return detail::query<HolefillLoopInfo>(HOLEFILL_LOOP_INFO_INIT, holefill_mesh_loop_info, get(), loop_id);
    }
    Result<std::vector<HolefillLoopInfo>> loops() const {
        detail::Steps call;
        const uint64_t count = call.query(uint64_t{0}, holefill_mesh_loop_count, get());
        std::vector<HolefillLoopInfo> loops;
        for (uint64_t i = 0; i < count && call.is_success(); ++i) {
            loops.push_back(HOLEFILL_LOOP_INFO_INIT);
            call(holefill_mesh_loop_info, get(), i, &loops.back());
        }
        return call.result(std::move(loops));
    }
    /* The vertices of a loop, in the direction in which its triangles run. */
    Result<std::vector<uint64_t>> loop_vertices(uint64_t loop_id) const {
        detail::Steps call;
        const auto info = call.query<HolefillLoopInfo>(HOLEFILL_LOOP_INFO_INIT, holefill_mesh_loop_info, get(), loop_id);
        return call.result(call.rows<uint64_t>(info.vertex_count, 1, holefill_mesh_read_loop, get(), loop_id, 0));
    }
    /* The ids of the loops that a target names: every open loop, if there is none. */
    Result<std::vector<uint64_t>> find_loops(const Target& target = {}) const {
        return target.with([&](const HolefillTarget* t) {
            return detail::list<std::vector<uint64_t>>(holefill_mesh_find_loops, get(), t);
        });
    }

    /* Fills holes: every open loop, if no target is given. */
    Result<Report> fill(const Target& target, const Options& options = {}) {
        return make<Report>(HolefillReport{}, options, [&](auto... last) {
            return target.with([&](const HolefillTarget* t) { return holefill_mesh_fill(get(), t, last...); });
        });
    }
    Result<Report> fill(const Options& options = {}) { return fill(Target(), options); }
    Result<void> undo() { return detail::run(holefill_mesh_undo, get()); }

    /* Makes patches and leaves the mesh as it is. */
    Result<Plan> plan(const Target& target, const Options& options = {}) const {
        return make<Plan>(HolefillPlan{}, options, [&](auto... last) {
            return target.with([&](const HolefillTarget* t) { return holefill_mesh_plan(get(), t, last...); });
        });
    }
    Result<Plan> plan(const Options& options = {}) const { return plan(Target(), options); }
    /* Appends the patches of a plan. Of `options` only the callbacks count. */
    Result<Report> apply(const Plan& plan, const Options& options = {}) {
        return make<Report>(HolefillReport{}, options,
                            [&](auto... last) { return holefill_plan_apply(plan.get(), get(), last...); });
    }
    HolefillMesh get() const noexcept { return handle_.get(); }

private:
    template <class T, class Read>
    Result<std::vector<std::array<T, 3>>> read_rows(uint64_t first, uint64_t HolefillMeshInfo::*total,
                                                    Read read) const {
        detail::Steps call;
        const auto info = call.query<HolefillMeshInfo>(HOLEFILL_MESH_INFO_INIT, holefill_mesh_info, get());
        const uint64_t count = first < info.*total ? info.*total - first : 0;
        return call.result(call.rows<std::array<T, 3>>(count, 1, read, get(), first));
    }
    template <class Function>
    static Result<Mesh> make(Function function, const HolefillInput* a, const HolefillInput* b) {
        detail::Steps call;
        return call.result(Mesh(call.query(HolefillMesh{}, function, a, b)));
    }
    /* What `function(options, &handle, error)` makes. */
    template <class Owner, class Handle, class Function>
    static Result<Owner> make(Handle handle, const Options& options, Function function) {
        detail::Steps call;
        detail::Call given(options, call);
        handle = call.query(handle, [&](Handle* made, HolefillError* error) { return function(given.raw(), made, error); });
        Owner owner(handle, call.status());
        given.rethrow();
        return call.result(std::move(owner));
    }

    detail::Owned<HolefillMesh, holefill_mesh_free> handle_;
};

} // namespace holefill

#endif /* HOLEFILL_HPP */
