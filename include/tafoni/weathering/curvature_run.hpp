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
#include <tafoni/weathering/detail/border_neighbors.hpp>
#include <tafoni/weathering/detail/door_scale.hpp>
#include <tafoni/weathering/detail/edge_lengths.hpp>
#include <tafoni/weathering/detail/held_vertices.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
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
    self_intersection,  ///< triangles that did not do so in the input cut each other, however short the step and whatever is held
    worn_away           ///< nothing is left that curvature could move and that is not held
};

/// Totals since the start. Equal runs give equal reports.
struct curvature_report {
    std::uint64_t iterations = 0;
    std::uint64_t edges_collapsed = 0;
    std::uint64_t retries = 0;       ///< steps that were taken back because triangles cut each other
    std::uint64_t held = 0;          ///< vertices now that are held still because triangles cut each other there
    double step = 0;                 ///< share of a mean edge that a vertex moves at most, now
    double removed_volume = 0;       ///< cubed length unit; of an open mesh right where its border stays
    curvature_stop stopped = curvature_stop::finished;  ///< of the last `run`
};

/// A surface that weathers [Skorkovská's thesis, section 9.3]. Owns a copy of the mesh.
///
/// Coordinates are shifted and scaled by a power of two to about unit size at the door, so the result does not
/// depend on the model's unit: the curvature of section 9.1 is scaled into [-1, 1] whenever it lies outside. The
/// state depends on mesh, policies and options only, never on threads; n then m iterations equal n + m (where triangles
/// are searched for cuts: unless the search at the end of n finds some that n + m would have lost again). When
/// anything throws, the state is that after the last complete iteration.
///
/// A search that finds cuts takes the surface back to that of the last sound search and halves the step; after
/// `hold_after` halvings it holds the vertices there still instead, for good or until the options are replaced. They
/// neither move nor are collapsed, and |H| is scaled by the largest of the others. From then on the step doubles after
/// every sound search on schedule, up to the given one.
template <class Process = curvature_weathering<>>
class curvature_run {
public:
    /// O(vertices + faces).
    /// \throws invalid_input  for a mesh with indices or coordinates out of range, or options out of range; `unsupported`
    ///         with the first face that is no triangle: `triangulate` makes some of it.
    template <polygon_mesh M>
    explicit curvature_run(M const& mesh, Process process = {}, curvature_options const& options = {})
        : process_((process.validate(), std::move(process))), options_((options.validate(), options)),
          surface_(triangle_surface::copy_of(mesh)), scale_(surface_.positions), input_(surface_.positions),
          input_triangles_(surface_.triangles),
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
        try {
            advance(iterations, context, threads);
        } catch (...) {
            report_.removed_volume = scale_.volume_to_user(start_volume_ - volume());
            throw;
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
    /// Nothing is held any more.
    void replace(curvature_options const& options) {
        options.validate();
        detail::curvature_state s = options.check_every > 0 ? snapshot() : detail::curvature_state{};
        s.held.clear();
        safe_ = std::move(s);
        held_.clear();
        holds_ = 0;
        report_.held = 0;
        report_.step = 1 / options.step_divisor;
        options_ = options;
    }

    // Checkpoints.
    /// The state as bytes, the same on every machine. O(vertices + faces).
    [[nodiscard]] std::vector<std::byte> checkpoint() const {
        return detail::write_checkpoint({.now = snapshot(), .safe = safe_, .retries = report_.retries, .holds = holds_, .step = report_.step},
                                        input_hash_, detail::parameter_hash(process_, options_, input_));
    }
    /// Goes on from a checkpoint of a run on the same mesh with the same policies and options: the same bits as without
    /// the break. \throws io_error  when the bytes are damaged or belong to another run; then nothing is changed.
    void resume(std::span<std::byte const> bytes) {
        detail::curvature_checkpoint c = detail::curvature_checkpoint_reader(bytes, input_.size())
                                             .read(input_hash_, detail::parameter_hash(process_, options_, input_));
        restore(std::move(c.now));
        safe_ = std::move(c.safe);
        report_.retries = c.retries;
        holds_ = c.holds;
        report_.step = c.step;
        report_.removed_volume = scale_.volume_to_user(start_volume_ - volume());
    }

private:
    [[nodiscard]] detail::curvature_state snapshot() const {
        return {surface_, new_vertex_, wear_, input_of_, held_, report_.iterations, report_.edges_collapsed};
    }
    void restore(detail::curvature_state s) noexcept {
        surface_ = std::move(s.surface);
        new_vertex_ = std::move(s.new_vertex);
        wear_ = std::move(s.wear);
        input_of_ = std::move(s.input_of);
        held_ = std::move(s.held);
        report_.held = static_cast<std::uint64_t>(std::count(held_.begin(), held_.end(), 1));
        report_.iterations = s.iterations;
        report_.edges_collapsed = s.edges_collapsed;
        fresh_ = false;
        mean_edge_ = -1;
        normal_.clear();
    }
    [[nodiscard]] surface_view view() const noexcept {
        return {.positions = surface_.positions, .triangles = surface_.triangles, .rings = &rings_};
    }
    template <executor Executor>
    void advance(std::uint64_t iterations, run_context const& context, Executor const& threads) {
        std::uint64_t const begin = report_.iterations;
        std::uint64_t const end = begin + iterations;
        double shown = 0;  // a step taken back does not take progress back
        auto const told = [&] {
            if (!context.on_progress) return true;
            double const done = static_cast<double>(std::max(report_.iterations, begin) - begin);
            shown = std::max(shown, iterations == 0 ? 1.0 : done / static_cast<double>(iterations));
            return context.on_progress({"weather", shown}) == step_control::proceed;
        };
        bool going = told();
        if (!going) report_.stopped = curvature_stop::observer;
        while (going && report_.iterations < end) {
            bool const moved = search_due() || iterate(threads);  // due already: what was thrown broke the search off
            if (!moved) report_.stopped = curvature_stop::worn_away;
            bool const scheduled = moved && search_due();
            bool const last = !moved || report_.iterations == end;
            std::vector<detail::triangle_pair> cuts;
            if (scheduled || (last && options_.check_every > 0 && report_.iterations > safe_.iterations)) cuts = new_cuts();
            if (!cuts.empty()) {
                report_.stopped = curvature_stop::finished;
                if (!step_back(std::move(cuts))) {
                    report_.stopped = curvature_stop::self_intersection;
                    break;
                }
            } else if (scheduled) {
                safe_ = snapshot();
                holds_ = 0;
                if (!held_.empty()) report_.step = std::min(2 * report_.step, 1 / options_.step_divisor);
            } else if (!moved) {
                break;
            }
            if (!told()) {
                report_.stopped = curvature_stop::observer;
                break;
            }
        }
    }

    [[nodiscard]] bool search_due() const noexcept {
        return options_.check_every > 0 && report_.iterations % options_.check_every == 0 && report_.iterations > safe_.iterations;
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
        double const largest = detail::largest_curvature(h_, held_);
        double const shrink = largest > 1 ? 1 / largest : 1.0;
        double const most = largest > 1 ? 1.0 : largest;
        if constexpr (!std::is_same_v<decltype(process_.direction), laplacian_direction>) {  // which looks at no normal
            normal_.resize(n);
            vertex_normals(view(), normal_, threads);
        }
        if (!(mean_edge_ >= 0)) mean_edge_ = detail::measure_edges(surface_.positions, rings_, threads).mean;
        double const reach = mean_edge_ * report_.step;
        double const power = options_.power;
        threads.for_blocks(n, detail::vertex_grain, [&](std::size_t begin, std::size_t end) {
            std::vector<std::uint32_t> along;
            for (std::size_t v = begin; v < end; ++v) {
                vec3 const p = surface_.positions[v];
                next_[v] = p;
                moved_[v] = 0;
                if (!(h_[v] > 0) || (!held_.empty() && held_[v] != 0)) continue;
                double const h = std::min(h_[v] * shrink, 1.0);
                std::span<std::uint32_t const> around = rings_.neighbors(v);
                if (rings_.is_border(v)) around = detail::neighbors_along_border(rings_, surface_.triangles, v, along);
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
                if (!is_finite(next_[v])) {
                    detail::fail<invalid_input>(errc::out_of_range, "curvature_run: the policies move vertex " + std::to_string(v) +
                                                                        " to a place that is not finite",
                                                {.kind = entity::vertex, .index = v});
                }
            }
        });
        bool const any = std::any_of(moved_.begin(), moved_.end(), [](double d) { return d > 0; });
        if (!any) return false;
        detail::edge_lengths const edges = detail::measure_edges(next_, rings_, threads);
        if (options_.topology == mesh_topology::adapt && edges.shortest < options_.small_edge * edges.mean &&
            thin_out(edges)) {
            return true;
        }
        // Nothing below throws.
        std::swap(surface_.positions, next_);
        for (std::size_t v = 0; v < n; ++v) {
            if (!(moved_[v] > 0)) continue;
            wear_[v] += moved_[v];
            input_of_[v] = vertex_index{};
        }
        mean_edge_ = edges.mean;
        ++report_.iterations;
        return true;
    }

    /// Finishes an iteration without the edges that have become too short; false where none can go. All or nothing.
    [[nodiscard]] bool thin_out(detail::edge_lengths const& edges) {
        double const limit = options_.small_edge * edges.mean;
        if (!detail::any_may_collapse(edges, limit, next_, surface_.triangles, rings_, held_)) return false;
        detail::curvature_state s = snapshot();
        s.surface.positions = next_;
        collapse_report const gone = detail::collapse_short_edges_fn::trusted(s.surface, limit, &rings_, held_);
        if (gone.collapsed == 0) return false;
        std::size_t const n = s.surface.positions.size();
        s.wear.assign(n, 0.0);
        s.input_of.assign(n, vertex_index{});
        if (!held_.empty()) s.held.assign(n, 0);
        std::vector<unsigned char> merged(n, 0);
        for (std::size_t v = 0; v < wear_.size(); ++v) {
            std::size_t const to = gone.new_vertex[v].value;
            s.wear[to] = std::max(s.wear[to], wear_[v] + moved_[v]);
            s.input_of[to] = merged[to] == 0 && !(moved_[v] > 0) ? input_of_[v] : vertex_index{};
            merged[to] = 1;
            if (!held_.empty() && held_[v] != 0) s.held[to] = 1;
        }
        for (vertex_index& v : s.new_vertex) v = gone.new_vertex[v.value];
        s.edges_collapsed += gone.collapsed;
        ++s.iterations;
        restore(std::move(s));
        return true;
    }

    /// Pairs of triangles that cut each other; none where they are not more than in the input.
    [[nodiscard]] std::vector<detail::triangle_pair> new_cuts() {
        std::vector<detail::triangle_pair> cuts = self_intersections(surface_.positions, surface_.triangles);
        if (cuts.empty()) return cuts;
        if (!cuts_at_start_) {
            std::vector<vec3> start = input_;
            scale_.enter(start);
            cuts_at_start_ = self_intersections(start, input_triangles_).size();
        }
        if (cuts.size() <= *cuts_at_start_) cuts.clear();
        return cuts;
    }
    /// Back to the last surface that was found sound, with half the step or with more held; false after too many times.
    [[nodiscard]] bool step_back(std::vector<detail::triangle_pair> cuts) {
        auto const below = [&](std::uint32_t halvings) {
            return report_.step * options_.step_divisor < std::ldexp(1.0, -static_cast<int>(halvings)) * 1.5;
        };
        bool const holding = options_.hold_after < options_.retries && below(options_.hold_after);
        bool const spent = holding ? holds_ >= options_.retries - options_.hold_after : below(options_.retries);
        detail::curvature_state s = safe_;
        if (holding && !spent) {
            s.held = detail::held_around(std::move(cuts), holds_ + 1, surface_, new_vertex_, s, *cuts_at_start_ > 0);
            std::vector<unsigned char>(s.held).swap(safe_.held);
        }
        restore(std::move(s));
        ++report_.retries;
        if (holding && !spent) ++holds_;
        if (!holding) report_.step /= 2;
        return !spent;
    }

    /// The sum over the closed chain about the origin of the door's frame. O(faces).
    [[nodiscard]] double volume() const noexcept {
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
    std::vector<std::array<std::uint32_t, 3>> input_triangles_;
    vertex_rings rings_{};
    bool fresh_ = false;
    std::vector<double> h_{};
    std::vector<vec3> next_{};
    std::vector<double> moved_{};
    std::vector<vec3> normal_{};
    std::vector<double> wear_{};
    std::vector<vertex_index> new_vertex_{};
    std::vector<vertex_index> input_of_{};    ///< vertex now -> that of the input it still is, or not valid
    std::vector<unsigned char> held_{};       ///< vertex now -> whether it is held still; empty: none is
    std::uint64_t holds_ = 0;                 ///< since the last sound search
    curvature_report report_{};
    double mean_edge_ = -1;  ///< of the surface now; below 0: not measured
    double start_volume_ = 0;
    std::optional<std::size_t> cuts_at_start_{};
    std::uint64_t input_hash_ = 0;
    detail::curvature_state safe_{};
};

}  // namespace tafoni

#endif
