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
#include <mutex>
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
class [[nodiscard]] Expected {
public:
    Expected(T value) : value_(std::move(value)) {}
    Expected(Failure failure) : failure_(std::move(failure)) {}

    bool has_value() const noexcept { return value_.has_value(); }
    explicit operator bool() const noexcept { return has_value(); }
    /* The value. There must be one. */
    T& value() & noexcept { return *value_; }
    const T& value() const& noexcept { return *value_; }
    T&& value() && noexcept { return std::move(*value_); }
    T& operator*() & noexcept { return *value_; }
    const T& operator*() const& noexcept { return *value_; }
    T&& operator*() && noexcept { return std::move(*value_); }
    T* operator->() noexcept { return &*value_; }
    const T* operator->() const noexcept { return &*value_; }
    /* Status HOLEFILL_STATUS_OK when there is a value. */
    const Failure& failure() const noexcept { return failure_; }

private:
    std::optional<T> value_;
    Failure failure_;
};

template <>
class [[nodiscard]] Expected<void> {
public:
    Expected() = default;
    Expected(Failure failure) : failure_(std::move(failure)) {}

    bool has_value() const noexcept { return failure_.status == HOLEFILL_STATUS_OK; }
    explicit operator bool() const noexcept { return has_value(); }
    const Failure& failure() const noexcept { return failure_; }

private:
    Failure failure_;
};

template <class T>
using Result = Expected<T>;

#endif

namespace detail {

template <class T>
constexpr HolefillType scalar_type() {
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

/* A text or list of unknown length: `read(buffer, capacity, &length)` is called for the length and for the elements. A
 * text needs room for one more. */
template <class List, class Read>
HolefillStatus read_list(List& list, Read read) {
    constexpr std::size_t END = std::is_same_v<List, std::string> ? 1 : 0;
    uint64_t length = 0;
    HolefillStatus status = read(static_cast<typename List::value_type*>(nullptr), uint64_t{0}, &length);
    if (status == HOLEFILL_STATUS_OK && length > 0) {
        list.resize(static_cast<std::size_t>(length) + END);
        status = read(list.data(), uint64_t{list.size()}, &length);
        list.resize(status == HOLEFILL_STATUS_OK ? static_cast<std::size_t>(length) : 0);
    }
    return status;
}

/* The error object of one call. */
class ErrorObject {
public:
    ErrorObject() = default;
    ErrorObject(const ErrorObject&) = delete;
    ErrorObject& operator=(const ErrorObject&) = delete;
    ~ErrorObject() { holefill_error_free(error_); }

    HolefillError* get() noexcept { return &error_; }

    Failure failure(HolefillStatus status) const {
        Failure failure{status, {}};
        read_list(failure.message, [&](char* buffer, uint64_t capacity, uint64_t* length) {
            return holefill_error_message(error_, buffer, capacity, length);
        });
        if (failure.message.empty()) {
            failure.message = holefill_status_message(status);
        }
        return failure;
    }

private:
    HolefillError error_{};
};

inline bool is_success(HolefillStatus status) {
    return status == HOLEFILL_STATUS_OK || status == HOLEFILL_STATUS_INCOMPLETE;
}

template <class T>
Result<T> result(HolefillStatus status, const ErrorObject& error, T&& value) {
    if (is_success(status)) {
        return std::forward<T>(value);
    }
#ifndef HOLEFILL_NO_EXCEPTIONS
    throw Exception(error.failure(status));
#else
    return error.failure(status);
#endif
}

/* What `function(value, error)` makes of a value, if its status is a success. */
template <class T, class Function>
Result<T> get(T value, Function function) {
    ErrorObject error;
    const HolefillStatus status = function(value, error.get());
    return result(status, error, std::move(value));
}

/* What the C function `function(arguments..., &value, error)` writes. */
template <class T, class Function, class... Arguments>
Result<T> query(T value, Function function, Arguments... arguments) {
    return get(std::move(value), [&](T& place, HolefillError* error) { return function(arguments..., &place, error); });
}

/* The text or list that the C function `function(arguments..., buffer, capacity, &length, error)` writes. */
template <class List, class Function, class... Arguments>
HolefillStatus read(List& list, HolefillError* error, Function function, Arguments... arguments) {
    return read_list(list, [&](auto* buffer, uint64_t capacity, uint64_t* length) {
        return function(arguments..., buffer, capacity, length, error);
    });
}

/* Nothing, if the status of the C function `function(arguments..., error)` is a success. */
template <class Function, class... Arguments>
Result<void> run(Function function, Arguments... arguments) {
    ErrorObject error;
    const HolefillStatus status = function(arguments..., error.get());
    if (!is_success(status)) {
#ifndef HOLEFILL_NO_EXCEPTIONS
        throw Exception(error.failure(status));
#else
        return error.failure(status);
#endif
    }
    return Result<void>();
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
        return detail::run([&](HolefillError* error) {
            Parameters parameters;
            HolefillStatus status = make(parameters, error);
            if (status == HOLEFILL_STATUS_OK) {
                status = holefill_parameters_set(parameters.get(), name, value, error);
            }
            if (status == HOLEFILL_STATUS_OK) {
                named_.emplace_back(name, value);
            }
            return status;
        });
    }

private:
    friend class detail::Call;
    using Parameters = detail::Owned<HolefillParameters, holefill_parameters_free>;

    /* Makes a set of the parameters that were set. */
    HolefillStatus make(Parameters& parameters, HolefillError* error) const {
        HolefillParameters handle{};
        HolefillStatus status = holefill_parameters_new(&handle, error);
        parameters = Parameters(handle);
        for (std::size_t i = 0; status == HOLEFILL_STATUS_OK && i < named_.size(); ++i) {
            status = holefill_parameters_set(handle, named_[i].first.c_str(), named_[i].second.c_str(), error);
        }
        return status;
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
        bool goes_on = true;
        self.guarded([&] { goes_on = !self.progress_ || self.progress_(*progress); });
        return goes_on && !self.has_thrown() ? 0 : 1;
    }
    static void log(HolefillLogLevel level, const char* message, void* data) {
        Callbacks& self = *static_cast<Callbacks*>(data);
        self.guarded([&] { self.log_(level, message); });
    }

private:
    template <class Function>
    void guarded(Function function) {
#ifndef HOLEFILL_NO_EXCEPTIONS
        try {
            function();
        } catch (...) {
            const std::lock_guard<std::mutex> lock(mutex_);
            if (!thrown_) {
                thrown_ = std::current_exception();
            }
        }
#else
        function();
#endif
    }
    bool has_thrown() {
#ifndef HOLEFILL_NO_EXCEPTIONS
        const std::lock_guard<std::mutex> lock(mutex_);
        return static_cast<bool>(thrown_);
#else
        return false;
#endif
    }

    const Options::Progress& progress_;
    const Options::Log& log_;
#ifndef HOLEFILL_NO_EXCEPTIONS
    std::mutex mutex_;
    std::exception_ptr thrown_;
#endif
};

/* One call with options. */
class Call : public Callbacks {
public:
    explicit Call(const Options& options)
        : Callbacks(options.progress_, options.log_), options_(options), raw_(options.raw_) {
        Callbacks* callbacks = this;
        raw_.method = options.method_.empty() ? nullptr : options.method_.c_str();
        if (options.progress_ || options.log_) {
            raw_.progress = &Callbacks::progress;
            raw_.progress_data = callbacks;
        }
        if (options.log_) {
            raw_.log = &Callbacks::log;
            raw_.log_data = callbacks;
        }
    }
    /* Calls `function` with the options as C has them. */
    template <class Function>
    HolefillStatus run(HolefillError* error, Function function) {
        HolefillStatus status = options_.named_.empty() ? HOLEFILL_STATUS_OK : options_.make(parameters_, error);
        if (status == HOLEFILL_STATUS_OK) {
            raw_.parameters = parameters_.get();
            status = function(&raw_);
        }
        return status;
    }

private:
    const Options& options_;
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
        return detail::get(Hole{HOLEFILL_HOLE_INIT, {}, {}, {}},
                           [&](auto& hole, auto* error) { return read_hole(index, hole, error); });
    }
    Result<std::vector<Hole>> holes() const {
        return detail::get(std::vector<Hole>(), [&](auto& holes, auto* error) {
            HolefillSummary summary = HOLEFILL_SUMMARY_INIT;
            HolefillStatus status = holefill_report_summary(get(), &summary, error);
            for (uint64_t i = 0; status == HOLEFILL_STATUS_OK && i < summary.hole_count; ++i) {
                holes.push_back(Hole{HOLEFILL_HOLE_INIT, {}, {}, {}});
                status = read_hole(i, holes.back(), error);
            }
            return status;
        });
    }
    /* Everything, as holefill_report_json says. */
    Result<std::string> json() const {
        return detail::get(std::string(), [&](auto& text, auto* error) {
            return detail::read(text, error, holefill_report_json, get());
        });
    }
    HolefillReport get() const noexcept { return handle_.get(); }

private:
    HolefillStatus read_hole(uint64_t index, Hole& hole, HolefillError* error) const {
        HolefillStatus status = holefill_report_hole(get(), index, &hole, error);
        if (status == HOLEFILL_STATUS_OK) {
            status = detail::read(hole.reason, error, holefill_report_reason, get(), index);
        }
        for (uint32_t k = 0; status == HOLEFILL_STATUS_OK && k < hole.tried_count; ++k) {
            Attempt attempt;
            const char* method = nullptr;
            status = detail::read(attempt.reason, error, holefill_report_tried, get(), index, k, &method);
            attempt.method = method ? method : "";
            hole.tried.push_back(std::move(attempt));
        }
        if (status == HOLEFILL_STATUS_OK) {
            HolefillPrediction found = HOLEFILL_PREDICTION_INIT;
            status = holefill_report_prediction(get(), index, &found, nullptr);
            if (status == HOLEFILL_STATUS_OK) {
                hole.prediction = found;
            } else if (status == HOLEFILL_STATUS_NOT_FOUND) {
                /* Most methods predict nothing, which is no error. */
                status = HOLEFILL_STATUS_OK;
            }
        }
        return status;
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
        return detail::get(Report({}, status_), [&](auto& report, auto* error) {
            HolefillReport handle{};
            const HolefillStatus status = holefill_plan_report(get(), &handle, error);
            report = Report(handle, status_);
            return status;
        });
    }
    /* The patch for a loop. Fails with HOLEFILL_STATUS_NOT_FOUND when the plan has none: its report says why. */
    Result<Patch> patch(uint64_t loop_id) const {
        return detail::get(Patch(), [&](auto& patch, auto* error) {
            HolefillPatchInfo info = HOLEFILL_PATCH_INFO_INIT;
            HolefillStatus status = holefill_plan_patch(get(), loop_id, &info, error);
            if (status == HOLEFILL_STATUS_OK) {
                patch.first_vertex = info.first_vertex;
                patch.positions.resize(static_cast<std::size_t>(info.vertex_count));
                const HolefillOutput output{patch.positions.data(), info.vertex_count, 0, HOLEFILL_TYPE_F64, 0};
                status = holefill_plan_read_positions(get(), loop_id, 0, &output, error);
            }
            if (status == HOLEFILL_STATUS_OK) {
                patch.triangles.resize(static_cast<std::size_t>(info.triangle_count));
                const HolefillOutput output{patch.triangles.data(), info.triangle_count, 0, HOLEFILL_TYPE_U64, 0};
                status = holefill_plan_read_triangles(get(), loop_id, 0, &output, error);
            }
            return status;
        });
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
        return detail::get(Mesh({}), [&](auto& mesh, auto* error) {
            HolefillMesh handle{};
            const HolefillStatus status =
                holefill_mesh_from_points(points.get(), normals ? normals->get() : nullptr,
                                          colors ? colors->get() : nullptr, &raw, &handle, &became, error);
            mesh = Mesh(handle);
            callbacks.rethrow();
            if (summary && status == HOLEFILL_STATUS_OK) {
                *summary = became;
            }
            return status;
        });
    }

    Result<HolefillMeshInfo> info() const {
        return detail::query<HolefillMeshInfo>(HOLEFILL_MESH_INFO_INIT, holefill_mesh_info, get());
    }
    Result<HolefillDefects> defects() const {
        return detail::query<HolefillDefects>(HOLEFILL_DEFECTS_INIT, holefill_mesh_defects, get());
    }
    Result<void> prepare() const {
        return detail::run(holefill_mesh_prepare, get());
    }
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
        return detail::get(std::vector<Attribute>(), [&](auto& attributes, auto* error) {
            uint64_t count = 0;
            HolefillStatus status = holefill_mesh_attribute_count(get(), element, &count, error);
            for (uint64_t i = 0; status == HOLEFILL_STATUS_OK && i < count; ++i) {
                Attribute attribute{HOLEFILL_ATTRIBUTE_INFO_INIT, {}};
                status = holefill_mesh_attribute_info(get(), element, i, &attribute, error);
                if (status == HOLEFILL_STATUS_OK) {
                    status = detail::read(attribute.name, error, holefill_mesh_attribute_name, get(), element, i);
                }
                attributes.push_back(std::move(attribute));
            }
            return status;
        });
    }
    /* The values of attribute `index` from row `first` on, one row after the other, in its own type or as double. */
    template <class T = double>
    Result<std::vector<T>> attribute(HolefillElement element, uint64_t index, uint64_t first = 0) const {
        return detail::get(std::vector<T>(), [&](auto& values, auto* error) {
            HolefillAttributeInfo info = HOLEFILL_ATTRIBUTE_INFO_INIT;
            HolefillStatus status = holefill_mesh_attribute_info(get(), element, index, &info, error);
            if (status == HOLEFILL_STATUS_OK) {
                const uint64_t count = first < info.count ? info.count - first : 0;
                values.resize(static_cast<std::size_t>(count * info.components));
                const HolefillOutput output{values.data(), count, 0, detail::scalar_type<T>(), 0};
                status = holefill_mesh_read_attribute(get(), element, index, first, &output, error);
            }
            return status;
        });
    }

    Result<uint64_t> loop_count() const {
        return detail::query(uint64_t{0}, holefill_mesh_loop_count, get());
    }
    Result<HolefillLoopInfo> loop(uint64_t loop_id) const {
        return detail::query<HolefillLoopInfo>(HOLEFILL_LOOP_INFO_INIT, holefill_mesh_loop_info, get(), loop_id);
    }
    Result<std::vector<HolefillLoopInfo>> loops() const {
        using Loops = std::vector<HolefillLoopInfo>;
        return detail::get(Loops(), [&](auto& loops, auto* error) {
            uint64_t count = 0;
            HolefillStatus status = holefill_mesh_loop_count(get(), &count, error);
            for (uint64_t i = 0; status == HOLEFILL_STATUS_OK && i < count; ++i) {
                loops.push_back(HOLEFILL_LOOP_INFO_INIT);
                status = holefill_mesh_loop_info(get(), i, &loops.back(), error);
            }
            return status;
        });
    }
    /* The vertices of a loop, in the direction in which its triangles run. */
    Result<std::vector<uint64_t>> loop_vertices(uint64_t loop_id) const {
        return detail::get(std::vector<uint64_t>(), [&](auto& vertices, auto* error) {
            HolefillLoopInfo info = HOLEFILL_LOOP_INFO_INIT;
            HolefillStatus status = holefill_mesh_loop_info(get(), loop_id, &info, error);
            if (status == HOLEFILL_STATUS_OK) {
                vertices.resize(static_cast<std::size_t>(info.vertex_count));
                const HolefillOutput output{vertices.data(), info.vertex_count, 0, HOLEFILL_TYPE_U64, 0};
                status = holefill_mesh_read_loop(get(), loop_id, 0, &output, error);
            }
            return status;
        });
    }
    Result<uint64_t> find_edge(uint64_t from, uint64_t to) const {
        return detail::query(uint64_t{0}, holefill_mesh_find_edge, get(), from, to);
    }
    Result<std::vector<uint64_t>> find_vertices(const Rows<1>& vertices) const {
        return detail::get(std::vector<uint64_t>(), [&](auto& ids, auto* error) {
            return detail::read(ids, error, holefill_mesh_find_vertices, get(), vertices.get());
        });
    }
    Result<std::vector<uint64_t>> select(const Selection& selection) const {
        const HolefillSelection raw = selection.raw();
        return detail::get(std::vector<uint64_t>(), [&](auto& ids, auto* error) {
            return detail::read(ids, error, holefill_mesh_select, get(), &raw);
        });
    }

    /* Fills holes: every open loop, if no target is given. */
    Result<Report> fill(const Target& target, const Options& options = {}) {
        return make<HolefillReport, Report>(options, [&](auto* raw, auto* report, auto* error) {
            return target.with([&](const HolefillTarget* t) { return holefill_mesh_fill(get(), t, raw, report, error); });
        });
    }
    Result<Report> fill(const Options& options = {}) { return fill(Target(), options); }
    Result<void> undo() {
        return detail::run(holefill_mesh_undo, get());
    }

    /* Makes patches and leaves the mesh as it is. */
    Result<Plan> plan(const Target& target, const Options& options = {}) const {
        return make<HolefillPlan, Plan>(options, [&](auto* raw, auto* plan, auto* error) {
            return target.with([&](const HolefillTarget* t) { return holefill_mesh_plan(get(), t, raw, plan, error); });
        });
    }
    Result<Plan> plan(const Options& options = {}) const { return plan(Target(), options); }
    /* Appends the patches of a plan. Of `options` only the callbacks count. */
    Result<Report> apply(const Plan& plan, const Options& options = {}) {
        return make<HolefillReport, Report>(options, [&](auto* raw, auto* report, auto* error) {
            return holefill_plan_apply(plan.get(), get(), raw, report, error);
        });
    }
    HolefillMesh get() const noexcept { return handle_.get(); }

private:
    template <class T, class Read>
    Result<std::vector<std::array<T, 3>>> read_rows(uint64_t first, uint64_t HolefillMeshInfo::*total,
                                                    Read read) const {
        using List = std::vector<std::array<T, 3>>;
        return detail::get(List(), [&](auto& rows, auto* error) {
            HolefillMeshInfo info = HOLEFILL_MESH_INFO_INIT;
            HolefillStatus status = holefill_mesh_info(get(), &info, error);
            if (status == HOLEFILL_STATUS_OK) {
                rows.resize(static_cast<std::size_t>(first < info.*total ? info.*total - first : 0));
                const HolefillOutput output{rows.data(), rows.size(), 0, detail::scalar_type<T>(), 0};
                status = read(get(), first, &output, error);
            }
            return status;
        });
    }
    template <class Function>
    static Result<Mesh> make(Function function, const HolefillInput* a, const HolefillInput* b) {
        return detail::get(Mesh({}), [&](auto& mesh, auto* error) {
            HolefillMesh handle{};
            const HolefillStatus status = function(a, b, &handle, error);
            mesh = Mesh(handle);
            return status;
        });
    }
    template <class Handle, class Owner, class Function>
    static Result<Owner> make(const Options& options, Function function) {
        return detail::get(Owner(Handle{}), [&](auto& owner, auto* error) {
            Handle handle{};
            detail::Call call(options);
            const HolefillStatus status =
                call.run(error, [&](const HolefillFillOptions* raw) { return function(raw, &handle, error); });
            owner = Owner(handle, status);
            call.rethrow();
            return status;
        });
    }

    detail::Owned<HolefillMesh, holefill_mesh_free> handle_;
};

} // namespace holefill

#endif /* HOLEFILL_HPP */
