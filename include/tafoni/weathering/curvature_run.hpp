/// \file
/// Curvature weathering of a mesh: the surface that wears, and the loop over the iterations.
#ifndef TAFONI_WEATHERING_CURVATURE_RUN_HPP
#define TAFONI_WEATHERING_CURVATURE_RUN_HPP

#include <tafoni/core/elementary.hpp>
#include <tafoni/core/executor.hpp>
#include <tafoni/core/run_context.hpp>
#include <tafoni/curvature/vertex_normals.hpp>
#include <tafoni/geometry/self_intersections.hpp>
#include <tafoni/geometry/triangle_surface.hpp>
#include <tafoni/repair/collapse_short_edges.hpp>
#include <tafoni/weathering/curvature_checkpoint.hpp>
#include <tafoni/weathering/curvature_weathering.hpp>
#include <tafoni/weathering/detail/door_scale.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace tafoni {

/// Why a run ended.
enum class curvature_stop : std::uint8_t {
    finished,
    observer,           ///< an observer said stop
    self_intersection,  ///< triangles cut each other however short the step
    worn_away           ///< nothing is left that curvature could move
};

/// Totals since the start. Equal runs give equal reports.
struct curvature_report {
    std::uint64_t iterations = 0;
    std::uint64_t edges_collapsed = 0;
    std::uint64_t retries = 0;       ///< steps that were taken back because triangles cut each other
    double step = 0;                 ///< share of a mean edge that a vertex moves at most, now
    double removed_volume = 0;       ///< of the closed chain, cubed length unit; 0 for an open mesh's open part
    curvature_stop stopped = curvature_stop::finished;  ///< of the last `run`
};

/// A surface that weathers [Skala's thesis, section 9.3]. Owns a copy of the mesh.
///
/// Coordinates are shifted and scaled by a power of two to about unit size at the door, so the result does not
/// depend on the model's unit: the curvature of section 9.1 is scaled into [-1, 1] whenever it lies outside. The
/// state depends on mesh, policies and options only, never on threads; n then m iterations equal n + m. When
/// anything throws, the state is that after the last complete iteration.
template <class Process = curvature_weathering<>>
class curvature_run {
public:
    /// O(vertices + faces).
    /// \throws invalid_input  for a mesh with indices or coordinates out of range, or options out of range.
    template <polygon_mesh M>
    explicit curvature_run(M const& mesh, Process process = {}, curvature_options const& options = {})
        : process_((process.validate(), std::move(process))), options_((options.validate(), options)),
          surface_(triangle_surface::copy_of(mesh)), scale_(surface_.positions), input_(surface_.positions),
          input_hash_(detail::surface_hash(surface_)) {
        scale_.enter(surface_.positions);
        report_.step = 1 / options_.step_divisor;
        start_volume_ = volume();
        new_vertex_.resize(surface_.positions.size());
        for (std::size_t v = 0; v < new_vertex_.size(); ++v) new_vertex_[v] = vertex_index{v};
        wear_.assign(surface_.positions.size(), 0.0);
        input_of_ = new_vertex_;
        if (options_.check_every > 0) safe_ = snapshot();
    }

    /// Adds iterations. Progress under the stage "weather"; an observer's `stop` ends the run after an iteration.
    /// O(vertices + faces) each, and O(n log n) for every search for cuts.
    template <executor Executor = inline_executor>
    curvature_report run(std::uint64_t iterations, run_context const& context = {}, Executor const& threads = {}) {
        report_.stopped = curvature_stop::finished;
        auto const told = [&](std::uint64_t done) {
            if (!context.on_progress) return true;
            double const share = iterations == 0 ? 1.0 : static_cast<double>(done) / static_cast<double>(iterations);
            return context.on_progress({"weather", share}) == step_control::proceed;
        };
        std::uint64_t const end = report_.iterations + iterations;
        std::uint64_t const begin = report_.iterations;
        bool going = told(0);
        if (!going) report_.stopped = curvature_stop::observer;
        while (going && report_.iterations < end) {
            if (!iterate(threads)) {
                report_.stopped = curvature_stop::worn_away;
                break;
            }
            bool const due = options_.check_every > 0 &&
                             (report_.iterations % options_.check_every == 0 || report_.iterations == end);
            if (due && !accept()) {
                report_.stopped = curvature_stop::self_intersection;
                break;
            }
            if (!told(report_.iterations - begin)) {
                report_.stopped = curvature_stop::observer;
                break;
            }
        }
        report_.removed_volume = scale_.volume_to_user(start_volume_ - volume());
        return report_;
    }

    // State.

    /// The surface in the user's frame; vertices that never moved have the input's very coordinates. O(vertices + faces).
    [[nodiscard]] triangle_surface surface() const {
        triangle_surface out = surface_;
        for (std::size_t v = 0; v < out.positions.size(); ++v) {
            out.positions[v] = input_of_[v].valid() ? input_[input_of_[v].value] : scale_.point_to_user(out.positions[v]);
        }
        return out;
    }
    /// Vertex of the input -> vertex now; of collapsed edges both ends lead to one.
    [[nodiscard]] std::span<vertex_index const> new_vertex() const noexcept { return new_vertex_; }
    /// Length that each vertex has moved along its way, length unit; of a collapsed edge the longer way.
    [[nodiscard]] std::vector<double> wear() const {
        std::vector<double> out = wear_;
        for (double& w : out) w = scale_.length_to_user(w);
        return out;
    }
    /// Mean curvature now, 1 / length unit. O(vertices + faces).
    template <executor Executor = inline_executor>
    [[nodiscard]] std::vector<double> curvature(Executor const& threads = {}) {
        refresh();
        std::vector<double> h(surface_.positions.size());
        process_.estimator(view(), h, threads);
        for (double& x : h) x = scale_.curvature_to_user(x);
        return h;
    }
    [[nodiscard]] curvature_report const& report() const noexcept { return report_; }
    [[nodiscard]] Process const& process() const noexcept { return process_; }
    [[nodiscard]] curvature_options const& options() const noexcept { return options_; }

    /// From the next iteration on. \throws invalid_input  as the constructor; then nothing is replaced.
    void replace(Process process) {
        process.validate();
        process_ = std::move(process);
    }
    void replace(curvature_options const& options) {
        options.validate();
        report_.step = 1 / options.step_divisor;
        options_ = options;
        if (options_.check_every > 0) safe_ = snapshot();
    }

    // Checkpoints.

    /// The state as bytes, the same on every machine. O(vertices + faces).
    [[nodiscard]] std::vector<std::byte> checkpoint() const {
        return detail::write_checkpoint({.now = snapshot(), .safe = safe_, .retries = report_.retries, .step = report_.step},
                                        input_hash_, detail::parameter_hash(process_, options_, input_));
    }
    /// Goes on from a checkpoint of a run on the same mesh with the same policies and options: the same bits as without
    /// the break. 	hrows io_error  when the bytes are damaged or belong to another run; then nothing is changed.
    void resume(std::span<std::byte const> bytes) {
        detail::curvature_checkpoint c = detail::curvature_checkpoint_reader(bytes, input_.size())
                                             .read(input_hash_, detail::parameter_hash(process_, options_, input_));
        restore(std::move(c.now));
        safe_ = std::move(c.safe);
        report_.retries = c.retries;
        report_.step = c.step;
        report_.removed_volume = scale_.volume_to_user(start_volume_ - volume());
    }

private:
    [[nodiscard]] detail::curvature_state snapshot() const {
        return {surface_, new_vertex_, wear_, input_of_, report_.iterations, report_.edges_collapsed};
    }
    void restore(detail::curvature_state s) {
        surface_ = std::move(s.surface);
        new_vertex_ = std::move(s.new_vertex);
        wear_ = std::move(s.wear);
        input_of_ = std::move(s.input_of);
        report_.iterations = s.iterations;
        report_.edges_collapsed = s.edges_collapsed;
        fresh_ = false;
        mean_edge_ = -1;
        normal_.clear();
    }
    [[nodiscard]] surface_view view() const noexcept {
        return {.positions = surface_.positions, .triangles = surface_.triangles, .rings = &rings_};
    }
    void refresh() {
        if (fresh_) return;
        rings_ = vertex_rings(surface_.positions.size(), surface_.triangles);
        fresh_ = true;
    }

    /// False where no vertex moves.
    template <executor Executor>
    bool iterate(Executor const& threads) {
        refresh();
        std::size_t const n = surface_.positions.size();
        h_.resize(n);
        next_.resize(n);
        moved_.resize(n);
        process_.estimator(view(), std::span<double>(h_), threads);
        double largest = 0;
        for (double const h : h_) largest = std::max(largest, std::fabs(h));
        double const shrink = largest > 1 ? 1 / largest : 1.0;
        double const most = largest > 1 ? 1.0 : largest;
        if constexpr (std::is_same_v<decltype(process_.direction), laplacian_direction>) {
            // the normal is not looked at
        } else {
            normal_.resize(n);
            vertex_normals(view(), normal_, threads);
        }
        if (!(mean_edge_ >= 0)) measure(threads);
        double const reach = mean_edge_ * report_.step;
        double const power = options_.power;
        threads.for_blocks(n, detail::vertex_grain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t v = begin; v < end; ++v) {
                vec3 const p = surface_.positions[v];
                next_[v] = p;
                moved_[v] = 0;
                if (!(h_[v] > 0)) continue;
                double const h = std::min(h_[v] * shrink, 1.0);
                auto const around = rings_.neighbors(v);
                wear_point at{.position = scale_.point_to_user(p), .laplacian = vec3{0, 0, 0},
                              .normal = normal_.empty() ? vec3{0, 0, 0} : normal_[v],
                              .curvature = most > 0 ? h / most : 0.0};
                for (std::uint32_t const w : around) at.laplacian += surface_.positions[w] - p;
                double const share = 1 / static_cast<double>(around.size());
                at.laplacian = vec3{at.laplacian[0] * share, at.laplacian[1] * share, at.laplacian[2] * share};
                double const hard = std::max(process_.durability(at.position), Process::least_durability);
                double const d = std::min((power == 1 ? h : elementary::pow(h, power)) / hard, 1.0) * reach;
                vec3 const way = process_.direction.direction(at);
                vec3 const step{d * way[0], d * way[1], d * way[2]};
                next_[v] = vec3{p[0] + step[0], p[1] + step[1], p[2] + step[2]};
                moved_[v] = length(step);
            }
        });
        bool any = false;
        for (std::size_t v = 0; v < n; ++v) {
            if (!is_finite(next_[v])) {
                detail::fail<invalid_input>(errc::out_of_range, "curvature_run: the policies move vertex " + std::to_string(v) +
                                                                    " to a place that is not finite",
                                            {.kind = entity::vertex, .index = v});
            }
            any = any || moved_[v] > 0;
        }
        if (!any) return false;
        std::swap(surface_.positions, next_);
        for (std::size_t v = 0; v < n; ++v) {
            if (!(moved_[v] > 0)) continue;
            wear_[v] += moved_[v];
            input_of_[v] = vertex_index{};
        }
        ++report_.iterations;
        measure(threads);
        if (options_.topology == mesh_topology::adapt && shortest_ < options_.small_edge * mean_edge_) thin_out();
        return true;
    }

    /// Mean and shortest edge; blocks of one size, so that the sum does not depend on threads.
    template <executor Executor>
    void measure(Executor const& threads) {
        refresh();
        struct edge_sum {
            double sum = 0;
            std::size_t edges = 0;
            double least = std::numeric_limits<double>::infinity();
        };
        std::size_t const n = surface_.positions.size();
        std::vector<edge_sum> parts((n + detail::vertex_grain - 1) / detail::vertex_grain);
        threads.for_blocks(n, detail::vertex_grain, [&](std::size_t begin, std::size_t end) {
            edge_sum p;
            for (std::size_t v = begin; v < end; ++v) {
                vec3 const at = surface_.positions[v];
                for (std::uint32_t const w : rings_.neighbors(v)) {
                    if (w < v) continue;
                    double const l = length(surface_.positions[w] - at);
                    p.sum += l;
                    p.least = std::min(p.least, l);
                    ++p.edges;
                }
            }
            parts[begin / detail::vertex_grain] = p;
        });
        edge_sum all;
        for (edge_sum const& p : parts) {
            all.sum += p.sum;
            all.edges += p.edges;
            all.least = std::min(all.least, p.least);
        }
        mean_edge_ = all.edges > 0 ? all.sum / static_cast<double>(all.edges) : 0.0;
        shortest_ = all.least;
    }

    void thin_out() {
        double const threshold = options_.small_edge * mean_edge_;
        collapse_report const gone = detail::collapse_short_edges_fn::trusted(surface_, threshold, &rings_);
        if (gone.collapsed == 0) return;
        report_.edges_collapsed += gone.collapsed;
        std::size_t const n = surface_.positions.size();
        std::vector<double> wear(n, 0.0);
        std::vector<vertex_index> input_of(n);
        std::vector<unsigned char> sources(n, 0);
        for (std::size_t v = 0; v < wear_.size(); ++v) {
            std::size_t const to = gone.new_vertex[v].value;
            wear[to] = std::max(wear[to], wear_[v]);
            input_of[to] = sources[to]++ == 0 ? input_of_[v] : vertex_index{};
            if (sources[to] > 2) sources[to] = 2;
        }
        wear_ = std::move(wear);
        input_of_ = std::move(input_of);
        for (vertex_index& v : new_vertex_) v = gone.new_vertex[v.value];
        normal_.clear();
        fresh_ = false;
        mean_edge_ = -1;
    }

    /// Whether the surface since the last search is sound; else goes back to it and halves the step.
    bool accept() {
        if (self_intersections(surface_.positions, surface_.triangles).empty()) {
            safe_ = snapshot();
            return true;
        }
        restore(safe_);
        report_.step /= 2;
        ++report_.retries;
        return report_.step * options_.step_divisor > std::ldexp(1.0, -static_cast<int>(options_.retries) - 1) * 1.5;
    }

    /// Six times would do: the sum over the closed chain about the origin of the door's frame. O(faces).
    [[nodiscard]] double volume() const {
        double six = 0;
        auto const& p = surface_.positions;
        for (auto const& t : surface_.triangles) six += dot(p[t[0]], cross(p[t[1]], p[t[2]]));
        return six / 6;
    }

    Process process_;
    curvature_options options_;
    triangle_surface surface_;
    detail::door_scale scale_;
    std::vector<vec3> input_;               ///< positions as given
    vertex_rings rings_{};
    bool fresh_ = false;
    std::vector<double> h_{};
    std::vector<vec3> next_{};
    std::vector<double> moved_{};
    std::vector<vec3> normal_{};
    std::vector<double> wear_{};
    std::vector<vertex_index> new_vertex_{};
    std::vector<vertex_index> input_of_{};    ///< vertex now -> that of the input it still is, or not valid
    curvature_report report_{};
    double mean_edge_ = -1;  ///< of the surface now; below 0: not measured
    double shortest_ = 0;
    double start_volume_ = 0;
    std::uint64_t input_hash_ = 0;
    detail::curvature_state safe_{};
};

}  // namespace tafoni

#endif
