/* The C interface of holefill as C++17 classes: header only, nothing but holefill.h behind it.
 *
 * Meshes, plans, reports and options own their handles: they can be moved, not copied, and free themselves. What they
 * do, cost and guarantee is said at the C functions of nearly the same name.
 *
 * Errors. A function that can fail has the return type Result<T>. That is T, and failures are thrown as
 * holefill::Exception; unless HOLEFILL_NO_EXCEPTIONS is defined before the header is included: then it is
 * holefill::Expected<T>, which holds a value or a Failure, and the header compiles without exceptions. All
 * translation units of a program must agree on that macro. A hole that stays open is no failure of the call: the report
 * says so. std::bad_alloc may be thrown besides.
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
            static_assert(sizeof(T) <= 4, "signed integers have at most 32 bits");
            return sizeof(T) == 1 ? HOLEFILL_TYPE_I8 : sizeof(T) == 2 ? HOLEFILL_TYPE_I16 : HOLEFILL_TYPE_I32;
        } else {
            return sizeof(T) == 1   ? HOLEFILL_TYPE_U8
                   : sizeof(T) == 2 ? HOLEFILL_TYPE_U16
                   : sizeof(T) == 4 ? HOLEFILL_TYPE_U32
                                    : HOLEFILL_TYPE_U64;
        }
    }
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
        uint64_t length = 0;
        if (error_.id != 0 && holefill_error_message(error_, nullptr, 0, &length) == HOLEFILL_STATUS_OK) {
            failure.message.resize(static_cast<std::size_t>(length) + 1);
            holefill_error_message(error_, failure.message.data(), length + 1, &length);
            failure.message.resize(static_cast<std::size_t>(length));
        }
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

inline Result<void> result(HolefillStatus status, const ErrorObject& error) {
    if (!is_success(status)) {
#ifndef HOLEFILL_NO_EXCEPTIONS
        throw Exception(error.failure(status));
#else
        return error.failure(status);
#endif
    }
    return Result<void>();
}

/* Text of unknown length: `read(buffer, capacity, &length)` is called once for the length and once for the text. */
template <class Read>
HolefillStatus read_text(std::string& text, Read read) {
    uint64_t length = 0;
    HolefillStatus status = read(nullptr, 0, &length);
    if (status != HOLEFILL_STATUS_OK) {
        return status;
    }
    text.resize(static_cast<std::size_t>(length) + 1);
    status = read(text.data(), length + 1, &length);
    text.resize(status == HOLEFILL_STATUS_OK ? static_cast<std::size_t>(length) : 0);
    return status;
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
};

/* What is filled how. Parameters that have names are set with `set`; holefill_parameter_name lists them. */
class Options {
public:
    /* Returns false to stop. */
    using Progress = std::function<bool(const HolefillProgress&)>;
    using Log = std::function<void(HolefillLogLevel, const char*)>;

    /* `auto` if it is never called. An unknown name is a failure of the call that the options are given to. */
    Options& method(std::string name) {
        method_ = std::move(name);
        return *this;
    }
    Options& seed(uint64_t seed) noexcept {
        raw_.seed = seed;
        return *this;
    }
    /* In seconds. */
    Options& time_budget(double seconds) noexcept {
        raw_.time_budget = seconds;
        return *this;
    }
    Options& density(double density) noexcept {
        raw_.density = density;
        return *this;
    }
    Options& max_new_vertices(uint64_t count) noexcept {
        raw_.max_new_vertices = count;
        return *this;
    }
    /* 0: as many as there are processors; 1: the calling thread. */
    Options& threads(uint32_t count) noexcept {
        raw_.threads = count;
        return *this;
    }
    Options& on_progress(Progress progress) {
        progress_ = std::move(progress);
        return *this;
    }
    Options& on_log(Log log, HolefillLogLevel level = HOLEFILL_LOG_INFO) {
        log_ = std::move(log);
        raw_.log_level = level;
        return *this;
    }
    Result<void> set(const char* name, const char* value) {
        detail::ErrorObject error;
        HolefillStatus status = HOLEFILL_STATUS_OK;
        if (parameters_.get().id == 0) {
            HolefillParameters handle{};
            status = holefill_parameters_new(&handle, error.get());
            parameters_ = Parameters(handle);
        }
        if (status == HOLEFILL_STATUS_OK) {
            status = holefill_parameters_set(parameters_.get(), name, value, error.get());
        }
        return detail::result(status, error);
    }

private:
    friend class detail::Call;
    using Parameters = detail::Owned<HolefillParameters, holefill_parameters_free>;

    HolefillFillOptions raw_ = HOLEFILL_FILL_OPTIONS_INIT;
    std::string method_;
    Parameters parameters_;
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
    explicit Call(const Options& options) : Callbacks(options.progress_, options.log_), raw_(options.raw_) {
        Callbacks* callbacks = this;
        raw_.method = options.method_.empty() ? nullptr : options.method_.c_str();
        raw_.parameters = options.parameters_.get();
        if (options.progress_ || options.log_) {
            raw_.progress = &Callbacks::progress;
            raw_.progress_data = callbacks;
        }
        if (options.log_) {
            raw_.log = &Callbacks::log;
            raw_.log_data = callbacks;
        }
    }

    const HolefillFillOptions* get() const noexcept { return &raw_; }

private:
    HolefillFillOptions raw_;
};

} // namespace detail

/* A method that was tried and not used. */
struct Attempt {
    std::string method;
    std::string reason;
};

/* A candidate surface and its score; see holefill_report_score. */
struct Score {
    std::string candidate;
    double value = 0.0;
};

/* How the missing surface was predicted: the fields of HolefillPrediction, the lists and the text. */
struct Prediction : HolefillPrediction {
    std::vector<Score> scores;
    std::vector<std::string> crease_surfaces;
    std::string without_creases;
};

/* What happened to one hole: the fields of HolefillHole, the texts, and the prediction if a method made one. */
struct Hole : HolefillHole {
    std::string reason;
    std::vector<Attempt> tried;
    std::optional<Prediction> prediction;
};

/* What happened to all holes of a call. */
class Report {
public:
    explicit Report(HolefillReport handle) noexcept : handle_(handle) {}

    Result<HolefillSummary> summary() const {
        detail::ErrorObject error;
        HolefillSummary summary = HOLEFILL_SUMMARY_INIT;
        const HolefillStatus status = holefill_report_summary(handle_.get(), &summary, error.get());
        return detail::result(status, error, std::move(summary));
    }
    /* Entry `index`, in the order of the loops' ids. */
    Result<Hole> hole(uint64_t index) const {
        detail::ErrorObject error;
        Hole hole{HOLEFILL_HOLE_INIT, {}, {}, {}};
        const HolefillStatus status = read_hole(index, hole, error);
        return detail::result(status, error, std::move(hole));
    }
    Result<std::vector<Hole>> holes() const {
        detail::ErrorObject error;
        HolefillSummary summary = HOLEFILL_SUMMARY_INIT;
        HolefillStatus status = holefill_report_summary(handle_.get(), &summary, error.get());
        std::vector<Hole> holes;
        for (uint64_t i = 0; status == HOLEFILL_STATUS_OK && i < summary.hole_count; ++i) {
            holes.push_back(Hole{HOLEFILL_HOLE_INIT, {}, {}, {}});
            status = read_hole(i, holes.back(), error);
        }
        return detail::result(status, error, std::move(holes));
    }
    HolefillReport get() const noexcept { return handle_.get(); }

private:
    HolefillStatus read_hole(uint64_t index, Hole& hole, detail::ErrorObject& error) const {
        HolefillStatus status = holefill_report_hole(handle_.get(), index, &hole, error.get());
        if (status != HOLEFILL_STATUS_OK) {
            return status;
        }
        status = detail::read_text(hole.reason, [&](char* buffer, uint64_t capacity, uint64_t* length) {
            return holefill_report_reason(handle_.get(), index, buffer, capacity, length, error.get());
        });
        for (uint32_t k = 0; status == HOLEFILL_STATUS_OK && k < hole.tried_count; ++k) {
            Attempt attempt;
            const char* method = nullptr;
            status = detail::read_text(attempt.reason, [&](char* buffer, uint64_t capacity, uint64_t* length) {
                return holefill_report_tried(handle_.get(), index, k, &method, buffer, capacity, length,
                                             error.get());
            });
            attempt.method = method ? method : "";
            hole.tried.push_back(std::move(attempt));
        }
        return status == HOLEFILL_STATUS_OK ? read_prediction(index, hole, error) : status;
    }
    HolefillStatus read_prediction(uint64_t index, Hole& hole, detail::ErrorObject& error) const {
        Prediction found{HOLEFILL_PREDICTION_INIT, {}, {}, {}};
        /* Most methods predict nothing, which is no error. */
        HolefillStatus status = holefill_report_prediction(handle_.get(), index, &found, error.get());
        if (status == HOLEFILL_STATUS_NOT_FOUND) {
            return HOLEFILL_STATUS_OK;
        }
        const char* candidate = nullptr;
        for (uint64_t k = 0; status == HOLEFILL_STATUS_OK && k < found.score_count; ++k) {
            double score = 0.0;
            status = holefill_report_score(handle_.get(), index, k, &candidate, &score, error.get());
            if (status == HOLEFILL_STATUS_OK) {
                found.scores.push_back({candidate, score});
            }
        }
        for (uint64_t k = 0; status == HOLEFILL_STATUS_OK && k < found.crease_surface_count; ++k) {
            status = holefill_report_crease_surface(handle_.get(), index, k, &candidate, error.get());
            if (status == HOLEFILL_STATUS_OK) {
                found.crease_surfaces.push_back(candidate);
            }
        }
        if (status == HOLEFILL_STATUS_OK) {
            status = detail::read_text(found.without_creases, [&](char* buffer, uint64_t capacity, uint64_t* length) {
                return holefill_report_without_creases(handle_.get(), index, buffer, capacity, length, error.get());
            });
        }
        hole.prediction = std::move(found);
        return status;
    }

    detail::Owned<HolefillReport, holefill_report_free> handle_;
};

/* The patch for one hole. In `triangles` indices below `first_vertex` are vertices of the mesh (or of the patches
 * before it in its plan), and `first_vertex + i` is positions[i]. */
struct Patch {
    uint64_t first_vertex = 0;
    std::vector<std::array<double, 3>> positions;
    std::vector<std::array<uint64_t, 3>> triangles;
};

/* Patches for chosen holes, not yet part of the mesh. */
class Plan {
public:
    explicit Plan(HolefillPlan handle) noexcept : handle_(handle) {}

    Result<Report> report() const {
        detail::ErrorObject error;
        HolefillReport report{};
        const HolefillStatus status = holefill_plan_report(handle_.get(), &report, error.get());
        return detail::result(status, error, Report(report));
    }
    /* The patch for a loop. Fails with HOLEFILL_STATUS_NOT_FOUND when the plan has none: its report says why. */
    Result<Patch> patch(uint64_t loop_id) const {
        detail::ErrorObject error;
        HolefillPatchInfo info = HOLEFILL_PATCH_INFO_INIT;
        HolefillStatus status = holefill_plan_patch(handle_.get(), loop_id, &info, error.get());
        Patch patch;
        if (status == HOLEFILL_STATUS_OK) {
            patch.first_vertex = info.first_vertex;
            patch.positions.resize(static_cast<std::size_t>(info.vertex_count));
            const HolefillOutput output{patch.positions.data(), info.vertex_count, 0, HOLEFILL_TYPE_F64, 0};
            status = holefill_plan_read_positions(handle_.get(), loop_id, 0, &output, error.get());
        }
        if (status == HOLEFILL_STATUS_OK) {
            patch.triangles.resize(static_cast<std::size_t>(info.triangle_count));
            const HolefillOutput output{patch.triangles.data(), info.triangle_count, 0, HOLEFILL_TYPE_U64, 0};
            status = holefill_plan_read_triangles(handle_.get(), loop_id, 0, &output, error.get());
        }
        return detail::result(status, error, std::move(patch));
    }
    HolefillPlan get() const noexcept { return handle_.get(); }

private:
    detail::Owned<HolefillPlan, holefill_plan_free> handle_;
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
        detail::ErrorObject error;
        HolefillMesh mesh{};
        const HolefillStatus status =
            holefill_mesh_from_arrays(positions.get(), triangles.get(), &mesh, error.get());
        return detail::result(status, error, Mesh(mesh));
    }
    /* The last point is joined to the first. */
    static Result<Mesh> from_polyline(const Rows<3>& points) { return from_polyline(points, nullptr); }
    static Result<Mesh> from_polyline(const Rows<3>& points, const Rows<3>& normals) {
        return from_polyline(points, normals.get());
    }

    /* The points are the vertices. `normals` and `colors` have a row for each point, if they are there. `summary` gets
     * what became of the points, if it is not null. */
    static Result<Mesh> from_points(const Rows<3>& points, const std::optional<Rows<3>>& normals = std::nullopt,
                                    const std::optional<Rows<3>>& colors = std::nullopt,
                                    const PointOptions& options = {}, HolefillPointSummary* summary = nullptr) {
        detail::ErrorObject error;
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
        HolefillMesh handle{};
        const HolefillStatus status =
            holefill_mesh_from_points(points.get(), normals ? normals->get() : nullptr, colors ? colors->get() : nullptr,
                                      &raw, &handle, &became, error.get());
        Mesh mesh(handle);
        callbacks.rethrow();
        if (summary && status == HOLEFILL_STATUS_OK) {
            *summary = became;
        }
        return detail::result(status, error, std::move(mesh));
    }

    Result<HolefillMeshInfo> info() const {
        detail::ErrorObject error;
        HolefillMeshInfo info = HOLEFILL_MESH_INFO_INIT;
        const HolefillStatus status = holefill_mesh_info(handle_.get(), &info, error.get());
        return detail::result(status, error, std::move(info));
    }
    Result<HolefillDefects> defects() const {
        detail::ErrorObject error;
        HolefillDefects defects = HOLEFILL_DEFECTS_INIT;
        const HolefillStatus status = holefill_mesh_defects(handle_.get(), &defects, error.get());
        return detail::result(status, error, std::move(defects));
    }
    Result<void> prepare() const {
        detail::ErrorObject error;
        return detail::result(holefill_mesh_prepare(handle_.get(), error.get()), error);
    }
    /* The vertices from `first` on, as float or double. */
    template <class T = double>
    Result<std::vector<std::array<T, 3>>> positions(uint64_t first = 0) const {
        return read_rows<T>(first, &HolefillMeshInfo::vertex_count, holefill_mesh_read_positions);
    }
    /* The triangles from `first` on, as uint32_t or uint64_t. */
    template <class T = uint32_t>
    Result<std::vector<std::array<T, 3>>> triangles(uint64_t first = 0) const {
        return read_rows<T>(first, &HolefillMeshInfo::triangle_count, holefill_mesh_read_triangles);
    }

    /* `values` has `components` numbers for each vertex or triangle. */
    template <class T>
    Result<void> add_attribute(HolefillElement element, const char* name, uint32_t components,
                               const std::vector<T>& values) {
        detail::ErrorObject error;
        const HolefillInput input{values.data(), components == 0 ? 0 : values.size() / components, 0,
                                  detail::scalar_type<T>(), 0};
        return detail::result(
            holefill_mesh_add_attribute(handle_.get(), element, name, components, &input, error.get()), error);
    }
    Result<std::vector<Attribute>> attributes(HolefillElement element) const {
        detail::ErrorObject error;
        uint64_t count = 0;
        HolefillStatus status = holefill_mesh_attribute_count(handle_.get(), element, &count, error.get());
        std::vector<Attribute> attributes;
        for (uint64_t i = 0; status == HOLEFILL_STATUS_OK && i < count; ++i) {
            Attribute attribute{HOLEFILL_ATTRIBUTE_INFO_INIT, {}};
            status = holefill_mesh_attribute_info(handle_.get(), element, i, &attribute, error.get());
            if (status == HOLEFILL_STATUS_OK) {
                status = detail::read_text(attribute.name, [&](char* buffer, uint64_t capacity, uint64_t* length) {
                    return holefill_mesh_attribute_name(handle_.get(), element, i, buffer, capacity, length,
                                                        error.get());
                });
            }
            attributes.push_back(std::move(attribute));
        }
        return detail::result(status, error, std::move(attributes));
    }
    /* The values of attribute `index` from row `first` on, one row after the other, in its own type or as double. */
    template <class T = double>
    Result<std::vector<T>> attribute(HolefillElement element, uint64_t index, uint64_t first = 0) const {
        detail::ErrorObject error;
        HolefillAttributeInfo info = HOLEFILL_ATTRIBUTE_INFO_INIT;
        HolefillStatus status = holefill_mesh_attribute_info(handle_.get(), element, index, &info, error.get());
        std::vector<T> values;
        if (status == HOLEFILL_STATUS_OK) {
            const uint64_t count = first < info.count ? info.count - first : 0;
            values.resize(static_cast<std::size_t>(count * info.components));
            const HolefillOutput output{values.data(), count, 0, detail::scalar_type<T>(), 0};
            status = holefill_mesh_read_attribute(handle_.get(), element, index, first, &output, error.get());
        }
        return detail::result(status, error, std::move(values));
    }

    Result<uint64_t> loop_count() const {
        detail::ErrorObject error;
        uint64_t count = 0;
        const HolefillStatus status = holefill_mesh_loop_count(handle_.get(), &count, error.get());
        return detail::result(status, error, std::move(count));
    }
    Result<HolefillLoopInfo> loop(uint64_t loop_id) const {
        detail::ErrorObject error;
        HolefillLoopInfo info = HOLEFILL_LOOP_INFO_INIT;
        const HolefillStatus status = holefill_mesh_loop_info(handle_.get(), loop_id, &info, error.get());
        return detail::result(status, error, std::move(info));
    }
    Result<std::vector<HolefillLoopInfo>> loops() const {
        detail::ErrorObject error;
        uint64_t count = 0;
        HolefillStatus status = holefill_mesh_loop_count(handle_.get(), &count, error.get());
        std::vector<HolefillLoopInfo> loops;
        for (uint64_t i = 0; status == HOLEFILL_STATUS_OK && i < count; ++i) {
            loops.push_back(HOLEFILL_LOOP_INFO_INIT);
            status = holefill_mesh_loop_info(handle_.get(), i, &loops.back(), error.get());
        }
        return detail::result(status, error, std::move(loops));
    }
    /* The vertices of a loop, in the direction in which its triangles run. */
    Result<std::vector<uint64_t>> loop_vertices(uint64_t loop_id) const {
        detail::ErrorObject error;
        HolefillLoopInfo info = HOLEFILL_LOOP_INFO_INIT;
        HolefillStatus status = holefill_mesh_loop_info(handle_.get(), loop_id, &info, error.get());
        std::vector<uint64_t> vertices;
        if (status == HOLEFILL_STATUS_OK) {
            vertices.resize(static_cast<std::size_t>(info.vertex_count));
            const HolefillOutput output{vertices.data(), info.vertex_count, 0, HOLEFILL_TYPE_U64, 0};
            status = holefill_mesh_read_loop(handle_.get(), loop_id, 0, &output, error.get());
        }
        return detail::result(status, error, std::move(vertices));
    }
    Result<uint64_t> find_edge(uint64_t from, uint64_t to) const {
        detail::ErrorObject error;
        uint64_t loop_id = 0;
        const HolefillStatus status = holefill_mesh_find_edge(handle_.get(), from, to, &loop_id, error.get());
        return detail::result(status, error, std::move(loop_id));
    }
    Result<std::vector<uint64_t>> find_vertices(const Rows<1>& vertices) const {
        return read_ids([&](uint64_t* ids, uint64_t capacity, uint64_t* count, HolefillError* error) {
            return holefill_mesh_find_vertices(handle_.get(), vertices.get(), ids, capacity, count, error);
        });
    }
    Result<std::vector<uint64_t>> select(const Selection& selection) const {
        const HolefillSelection raw = to_c(selection);
        return read_ids([&](uint64_t* ids, uint64_t capacity, uint64_t* count, HolefillError* error) {
            return holefill_mesh_select(handle_.get(), &raw, ids, capacity, count, error);
        });
    }

    Result<Report> fill_loop(uint64_t loop_id, const Options& options = {}) {
        return make<HolefillReport, Report>(options, [&](const HolefillFillOptions* raw, HolefillReport* report,
                                                         HolefillError* error) {
            return holefill_mesh_fill_loop(handle_.get(), loop_id, raw, report, error);
        });
    }
    Result<Report> fill_edge(uint64_t from, uint64_t to, const Options& options = {}) {
        return make<HolefillReport, Report>(options, [&](const HolefillFillOptions* raw, HolefillReport* report,
                                                         HolefillError* error) {
            return holefill_mesh_fill_edge(handle_.get(), from, to, raw, report, error);
        });
    }
    Result<Report> fill_vertices(const Rows<1>& vertices, const Options& options = {}) {
        return make<HolefillReport, Report>(options, [&](const HolefillFillOptions* raw, HolefillReport* report,
                                                         HolefillError* error) {
            return holefill_mesh_fill_vertices(handle_.get(), vertices.get(), raw, report, error);
        });
    }
    Result<Report> fill_loops(const Rows<1>& loop_ids, const Options& options = {}) {
        return make<HolefillReport, Report>(options, [&](const HolefillFillOptions* raw, HolefillReport* report,
                                                         HolefillError* error) {
            return holefill_mesh_fill_loops(handle_.get(), loop_ids.get(), raw, report, error);
        });
    }
    /* Fills all open loops that the selection chooses. */
    Result<Report> fill_selected(const Selection& selection, const Options& options = {}) {
        const HolefillSelection rules = to_c(selection);
        return make<HolefillReport, Report>(options, [&](const HolefillFillOptions* raw, HolefillReport* report,
                                                         HolefillError* error) {
            return holefill_mesh_fill_selected(handle_.get(), &rules, raw, report, error);
        });
    }
    Result<Report> fill_all(const Options& options = {}) { return fill_selected(Selection{}, options); }
    Result<void> undo() {
        detail::ErrorObject error;
        return detail::result(holefill_mesh_undo(handle_.get(), error.get()), error);
    }

    Result<Plan> plan_loop(uint64_t loop_id, const Options& options = {}) const {
        return make<HolefillPlan, Plan>(options, [&](const HolefillFillOptions* raw, HolefillPlan* plan,
                                                     HolefillError* error) {
            return holefill_mesh_plan_loop(handle_.get(), loop_id, raw, plan, error);
        });
    }
    Result<Plan> plan_edge(uint64_t from, uint64_t to, const Options& options = {}) const {
        return make<HolefillPlan, Plan>(options, [&](const HolefillFillOptions* raw, HolefillPlan* plan,
                                                     HolefillError* error) {
            return holefill_mesh_plan_edge(handle_.get(), from, to, raw, plan, error);
        });
    }
    Result<Plan> plan_vertices(const Rows<1>& vertices, const Options& options = {}) const {
        return make<HolefillPlan, Plan>(options, [&](const HolefillFillOptions* raw, HolefillPlan* plan,
                                                     HolefillError* error) {
            return holefill_mesh_plan_vertices(handle_.get(), vertices.get(), raw, plan, error);
        });
    }
    Result<Plan> plan_loops(const Rows<1>& loop_ids, const Options& options = {}) const {
        return make<HolefillPlan, Plan>(options, [&](const HolefillFillOptions* raw, HolefillPlan* plan,
                                                     HolefillError* error) {
            return holefill_mesh_plan_loops(handle_.get(), loop_ids.get(), raw, plan, error);
        });
    }
    Result<Plan> plan_selected(const Selection& selection, const Options& options = {}) const {
        const HolefillSelection rules = to_c(selection);
        return make<HolefillPlan, Plan>(options, [&](const HolefillFillOptions* raw, HolefillPlan* plan,
                                                     HolefillError* error) {
            return holefill_mesh_plan_selected(handle_.get(), &rules, raw, plan, error);
        });
    }
    Result<Plan> plan_all(const Options& options = {}) const { return plan_selected(Selection{}, options); }
    /* Appends the patches of a plan. Of `options` only the callbacks count. */
    Result<Report> apply(const Plan& plan, const Options& options = {}) {
        return make<HolefillReport, Report>(options, [&](const HolefillFillOptions* raw, HolefillReport* report,
                                                         HolefillError* error) {
            return holefill_plan_apply(plan.get(), handle_.get(), raw, report, error);
        });
    }
    HolefillMesh get() const noexcept { return handle_.get(); }

private:
    static Result<Mesh> from_polyline(const Rows<3>& points, const HolefillInput* normals) {
        detail::ErrorObject error;
        HolefillMesh mesh{};
        const HolefillStatus status = holefill_mesh_from_polyline(points.get(), normals, &mesh, error.get());
        return detail::result(status, error, Mesh(mesh));
    }
    /* Points into `selection`. */
    static HolefillSelection to_c(const Selection& selection) {
        HolefillSelection raw = HOLEFILL_SELECTION_INIT;
        raw.only = *Rows<2>(selection.only).get();
        raw.keep = *Rows<2>(selection.keep).get();
        raw.max_edges = selection.max_edges;
        raw.max_perimeter = selection.max_perimeter;
        raw.keep_largest = selection.keep_largest;
        return raw;
    }
    template <class T, class Read>
    Result<std::vector<std::array<T, 3>>> read_rows(uint64_t first, uint64_t HolefillMeshInfo::*total,
                                                    Read read) const {
        detail::ErrorObject error;
        HolefillMeshInfo info = HOLEFILL_MESH_INFO_INIT;
        HolefillStatus status = holefill_mesh_info(handle_.get(), &info, error.get());
        std::vector<std::array<T, 3>> rows;
        if (status == HOLEFILL_STATUS_OK) {
            rows.resize(static_cast<std::size_t>(first < info.*total ? info.*total - first : 0));
            const HolefillOutput output{rows.data(), rows.size(), 0, detail::scalar_type<T>(), 0};
            status = read(handle_.get(), first, &output, error.get());
        }
        return detail::result(status, error, std::move(rows));
    }
    template <class Read>
    static Result<std::vector<uint64_t>> read_ids(Read read) {
        detail::ErrorObject error;
        uint64_t count = 0;
        std::vector<uint64_t> ids;
        HolefillStatus status = read(nullptr, 0, &count, error.get());
        if (status == HOLEFILL_STATUS_OK && count > 0) {
            ids.resize(static_cast<std::size_t>(count));
            status = read(ids.data(), count, &count, error.get());
        }
        return detail::result(status, error, std::move(ids));
    }
    template <class Handle, class Owner, class Function>
    static Result<Owner> make(const Options& options, Function function) {
        detail::ErrorObject error;
        detail::Call call(options);
        Handle handle{};
        const HolefillStatus status = function(call.get(), &handle, error.get());
        Owner owner(handle);
        call.rethrow();
        return detail::result(status, error, std::move(owner));
    }

    detail::Owned<HolefillMesh, holefill_mesh_free> handle_;
};

} // namespace holefill

#endif /* HOLEFILL_HPP */
