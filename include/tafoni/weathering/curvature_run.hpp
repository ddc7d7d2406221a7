/// \file
/// Curvature weathering of a mesh: the surface that wears, and the loop over the iterations.
#ifndef TAFONI_WEATHERING_CURVATURE_RUN_HPP
#define TAFONI_WEATHERING_CURVATURE_RUN_HPP

#include <tafoni/core/executor.hpp>
#include <tafoni/core/run_context.hpp>
#include <tafoni/curvature/concepts.hpp>
#include <tafoni/geometry/self_intersections.hpp>
#include <tafoni/geometry/triangle_surface.hpp>
#include <tafoni/geometry/vertex_rings.hpp>
#include <tafoni/weathering/curvature_checkpoint.hpp>
#include <tafoni/weathering/curvature_weathering.hpp>
#include <tafoni/weathering/detail/curvature_displacement.hpp>
#include <tafoni/weathering/detail/door_scale.hpp>
#include <tafoni/weathering/detail/edge_lengths.hpp>
#include <tafoni/weathering/detail/edge_thinning.hpp>
#include <tafoni/weathering/detail/held_vertices.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
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
          now_{.surface = triangle_surface::copy_of(mesh)}, scale_(now_.surface.positions), input_(now_.surface.positions),
          input_triangles_(now_.surface.triangles), input_hash_(detail::surface_hash(now_.surface)) {
        scale_.enter(now_.surface.positions);
        report_.step = 1 / options_.step_divisor;
        start_volume_ = volume();
        now_.new_vertex.resize(input_.size());
        for (std::size_t v = 0; v < input_.size(); ++v) now_.new_vertex[v] = vertex_index{v};
        now_.wear.assign(input_.size(), 0.0);
        now_.input_of = now_.new_vertex;
        if (options_.check_every > 0) safe_ = now_;
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
        triangle_surface out = now_.surface;
        for (std::size_t v = 0; v < out.positions.size(); ++v) {
            vertex_index const still = now_.input_of[v];
            out.positions[v] = still.valid() ? input_[still.value] : scale_.point_to_user(out.positions[v]);
        }
        return out;
    }
    /// Vertex of the input -> vertex now; of collapsed edges both ends lead to one.
    [[nodiscard]] std::span<vertex_index const> new_vertex() const noexcept { return now_.new_vertex; }
    /// Face of the input -> face now, not valid where it is gone. Faces keep their order and their corners. O(faces of the input).
    [[nodiscard]] std::vector<face_index> new_face() const {
        std::vector<face_index> out(input_triangles_.size());
        std::size_t next = 0;
        for (std::size_t f = 0; f < out.size() && next < now_.surface.triangles.size(); ++f) {
            bool same = true;
            for (std::size_t k = 0; k < 3; ++k) {
                same = same && now_.new_vertex[input_triangles_[f][k]].value == now_.surface.triangles[next][k];
            }
            if (same) out[f] = face_index{next++};
        }
        return out;
    }
    /// Length that each vertex has moved along its way, length unit; of a collapsed edge the longer way.
    [[nodiscard]] std::vector<double> wear() const {
        std::vector<double> out = now_.wear;
        for (double& w : out) w = scale_.length_to_user(w);
        return out;
    }
    /// Mean curvature now, 1 / length unit. O(vertices + faces).
    template <executor Executor = inline_executor>
    [[nodiscard]] std::vector<double> curvature(Executor const& threads = {}) const {
        std::vector<double> h(now_.surface.positions.size());
        vertex_rings const own = fresh_ ? vertex_rings{} : vertex_rings(h.size(), now_.surface.triangles);
        process_.estimator(view(fresh_ ? rings_ : own), h, threads);
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
        detail::curvature_state s = options.check_every > 0 ? now_ : detail::curvature_state{};
        s.held.clear();
        safe_ = std::move(s);
        now_.held.clear();
        holds_ = 0;
        report_.held = 0;
        report_.step = 1 / options.step_divisor;
        options_ = options;
    }

    // Checkpoints.
    /// The state as bytes, the same on every machine. O(vertices + faces).
    [[nodiscard]] std::vector<std::byte> checkpoint() const {
        return detail::write_checkpoint({.now = now_, .safe = safe_, .retries = report_.retries, .holds = holds_, .step = report_.step},
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
    void restore(detail::curvature_state s) noexcept {
        now_ = std::move(s);
        report_.held = static_cast<std::uint64_t>(std::count(now_.held.begin(), now_.held.end(), 1));
        told_totals();
        fresh_ = false;
        mean_edge_ = -1;
    }
    void told_totals() noexcept {
        report_.iterations = now_.iterations;
        report_.edges_collapsed = now_.edges_collapsed;
    }
    [[nodiscard]] surface_view view(vertex_rings const& rings) const noexcept {
        return {.positions = now_.surface.positions, .triangles = now_.surface.triangles, .rings = &rings, .room = &room_};
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
                safe_ = now_;
                holds_ = 0;
                if (!now_.held.empty()) report_.step = std::min(2 * report_.step, 1 / options_.step_divisor);
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

    /// False where no vertex moves.
    template <executor Executor>
    bool iterate(Executor const& threads) {
        if (!fresh_) rings_ = vertex_rings(now_.surface.positions.size(), now_.surface.triangles);
        fresh_ = true;
        if (!(mean_edge_ >= 0)) mean_edge_ = detail::measure_edges(now_.surface.positions, rings_, threads).mean;
        if (!displacement_.find(process_, view(rings_), scale_,
                                {.power = options_.power, .reach = mean_edge_ * report_.step, .held = now_.held}, threads)) {
            return false;
        }
        std::vector<vec3>& next = displacement_.next();
        std::span<double const> const moved = displacement_.moved();
        detail::edge_lengths const edges = detail::measure_edges(next, rings_, threads);
        double const limit = options_.small_edge * edges.mean;
        if (options_.topology == mesh_topology::adapt && edges.shortest < limit &&
            thinning_(now_, rings_, next, moved, edges, limit, threads)) {
            mean_edge_ = -1;
        } else {  // nothing below throws
            std::swap(now_.surface.positions, next);
            for (std::size_t v = 0; v < moved.size(); ++v) {
                if (!(moved[v] > 0)) continue;
                now_.wear[v] += moved[v];
                now_.input_of[v] = vertex_index{};
            }
            mean_edge_ = edges.mean;
            ++now_.iterations;
        }
        told_totals();
        return true;
    }

    /// Pairs of triangles that cut each other; none where they are not more than in the input.
    [[nodiscard]] std::vector<detail::triangle_pair> new_cuts() {
        std::vector<detail::triangle_pair> cuts = self_intersections(now_.surface.positions, now_.surface.triangles);
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
            s.held = detail::held_around(std::move(cuts), holds_ + 1, now_.surface, now_.new_vertex, s, *cuts_at_start_ > 0);
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
        auto const& p = now_.surface.positions;
        for (auto const& t : now_.surface.triangles) six += dot(p[t[0]], cross(p[t[1]], p[t[2]]));
        return six / 6;
    }

    Process process_;
    curvature_options options_;
    detail::curvature_state now_;
    detail::door_scale scale_;
    std::vector<vec3> input_;               ///< positions as given
    std::vector<std::array<std::uint32_t, 3>> input_triangles_;
    vertex_rings rings_{};
    bool fresh_ = false;                    ///< whether the rings are those of the surface
    mutable estimator_room room_{};
    detail::curvature_displacement displacement_{};
    detail::edge_thinning thinning_{};
    std::uint64_t holds_ = 0;               ///< since the last sound search
    curvature_report report_{};
    double mean_edge_ = -1;                 ///< of the surface now; below 0: not measured
    double start_volume_ = 0;
    std::optional<std::size_t> cuts_at_start_{};
    std::uint64_t input_hash_ = 0;
    detail::curvature_state safe_{};
};

}  // namespace tafoni

#endif
