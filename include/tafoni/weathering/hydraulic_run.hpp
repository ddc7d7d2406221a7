/// \file
/// Hydraulic erosion of a mesh by a particle fluid: the surface that wears, and the loop over the iterations.
#ifndef TAFONI_WEATHERING_HYDRAULIC_RUN_HPP
#define TAFONI_WEATHERING_HYDRAULIC_RUN_HPP

#include <tafoni/core/executor.hpp>
#include <tafoni/core/run_context.hpp>
#include <tafoni/fluid/concepts.hpp>
#include <tafoni/fluid/mesh_boundary.hpp>
#include <tafoni/geometry/refine_faces.hpp>
#include <tafoni/geometry/refined_origins.hpp>
#include <tafoni/geometry/triangle_surface.hpp>
#include <tafoni/weathering/detail/held_borders.hpp>
#include <tafoni/weathering/detail/particle_loads.hpp>
#include <tafoni/weathering/detail/sediment.hpp>
#include <tafoni/weathering/detail/swept_volume.hpp>
#include <tafoni/weathering/detail/water_contacts.hpp>
#include <tafoni/weathering/detail/wall_clearance.hpp>
#include <tafoni/weathering/detail/water_displacement.hpp>
#include <tafoni/weathering/hydraulic_checkpoint.hpp>
#include <tafoni/weathering/hydraulic_erosion.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace tafoni {

/// A surface under water [Skorkovská's thesis, chapters 8 and 9]. Owns a copy of the mesh, and the fluid.
///
/// An iteration lets the fluid take a step along the surface, then wears the surface by the particles that touch
/// it. With an exchange rule each particle takes rate x contact area x time from the corners of its face or
/// lays down what it carries; the contact area is that of the circle in which the face cuts the ball of the
/// particle's reach, pi (reach^2 - distance^2). With `curvature_erosion` the vertices within the influence of a
/// particle that touches go by (1 - distance / influence) H^n e / x, never outwards. The state depends on
/// mesh, fluid, process and options only, never on threads.
template <class Process, class Fluid>
class hydraulic_run {
    static_assert(exchange_rule<typename detail::rule_of<Process>::type>);  // `hydraulic_process`, one line nearer to the reason
    static_assert(particle_fluid<Fluid>);

public:
    /// O(vertices + faces). \throws invalid_input  for a mesh or parameters out of range; `unsupported` with the first
    /// face that is no triangle: `triangulate` makes some of it.
    template <polygon_mesh M>
    hydraulic_run(M const& mesh, Fluid fluid, Process process, hydraulic_options const& options = {})
        : process_(std::move(process)), options_((options.validate(), options)), fluid_(std::move(fluid)),
          surface_(triangle_surface::copy_of(mesh)), input_(surface_.positions), input_hash_(detail::surface_hash(surface_)),
          mean_edge_(surface_.mean_edge_length()), border_(surface_.positions, surface_.triangles) {
        if constexpr (requires { process_.validate(); }) process_.validate();
        std::size_t const n = surface_.positions.size();
        input_faces_ = surface_.triangles.size();
        origins_ = refined_origins(input_faces_);
        books_.due.assign(n, 0);
        wear_.assign(n, 0.0);
        flow_.assign(n, 0);
        sediment_.assign(n, 0);
        unit_ = detail::volume_unit(detail::largest_sweep(surface_) * (mean_edge_ / options_.step_divisor));
    }

    /// Adds iterations. Progress under the stage "weather"; an observer's `stop` ends the run after an iteration.
    /// Where an observer, a rule, an estimator, the fluid or the allocator throws, surface and report are those after the last whole
    /// iteration, and another `run` goes on as if nothing had been thrown (if the fluid does).
    /// O(vertices + faces + particles) each, beside the fluid's own cost.
    template <executor Executor = inline_executor>
    hydraulic_report run(std::uint64_t iterations, run_context const& context = {}, Executor const& threads = {}) {
        report_.stopped = hydraulic_stop::finished;
        for (std::uint64_t done = 0;; ++done) {
            double const share = iterations == 0 ? 1.0 : static_cast<double>(done) / static_cast<double>(iterations);
            if (context.on_progress && context.on_progress({"weather", share}) == step_control::stop) {
                report_.stopped = hydraulic_stop::observer;
                break;
            }
            if (done == iterations) break;
            iterate(threads);
        }
        report_.particles = fluid_.particle_count();
        return report_;
    }

    // State.

    /// Vertices of the input keep their numbers; those that refinement added follow.
    [[nodiscard]] triangle_surface const& surface() const noexcept { return surface_; }
    /// The edges that added vertices came into the middle of, and the input's face of each face: so that texture coordinates
    /// and other numbers of the host follow; `origins().carried(u)`.
    [[nodiscard]] refined_origins const& origins() const noexcept { return origins_; }
    [[nodiscard]] Fluid const& fluid() const noexcept { return fluid_; }
    [[nodiscard]] hydraulic_report const& report() const noexcept { return report_; }
    /// Way that each vertex has moved, length unit.
    [[nodiscard]] std::span<double const> wear() const noexcept { return wear_; }
    /// Contacts of particles with the faces at the vertex, summed over iterations.
    [[nodiscard]] std::span<std::uint64_t const> flow() const noexcept { return flow_; }
    /// Volume laid down less volume taken, cubed length unit. O(vertices).
    [[nodiscard]] std::vector<double> sediment() const {
        std::vector<double> out(sediment_.size());
        for (std::size_t v = 0; v < out.size(); ++v) out[v] = unit_.volume(sediment_[v]);
        return out;
    }
    /// Whether eroded = deposited + carried + left, in whole units: always.
    [[nodiscard]] bool balanced() const noexcept { return books_.balanced(); }

    // Checkpoints, of fluids that can be saved.

    /// The state as bytes, the same on every machine. O(vertices + faces + particles).
    [[nodiscard]] std::vector<std::byte> checkpoint() const requires saved_fluid<Fluid> {
        return detail::write_checkpoint({.surface = surface_, .wear = wear_, .flow = flow_, .sediment = sediment_, .books = books_,
                                         .report = report_, .ahead = ahead_, .clear = clear_, .given = given_, .origins = origins_},
                                        fluid_, input_hash_, detail::parameter_hash(process_, options_, input_));
    }
    /// Goes on from a checkpoint of a run on the same mesh with the same process, options and fluid: the same bits as
    /// without the break. \throws io_error  when the bytes are damaged or belong to another run; invalid_input  when the
    /// fluid's parameters are others; nothing is changed then.
    void resume(std::span<std::byte const> bytes) requires saved_fluid<Fluid> {
        Fluid fluid = fluid_;
        detail::hydraulic_state s = detail::hydraulic_checkpoint_reader(bytes, input_.size(), input_faces_)
                                        .read(fluid, input_hash_, detail::parameter_hash(process_, options_, input_));
        s.report.ledger = s.books.in(unit_);
        s.report.particles = fluid.particle_count();
        fluid_ = std::move(fluid);
        surface_ = std::move(s.surface);
        wear_ = std::move(s.wear);
        flow_ = std::move(s.flow);
        sediment_ = std::move(s.sediment);
        books_ = std::move(s.books);
        report_ = s.report;
        ahead_ = s.ahead;
        clear_ = std::move(s.clear);
        given_ = std::move(s.given);
        origins_ = std::move(s.origins);
        walls_.clear();
        fresh_ = false;
    }

private:
    [[nodiscard]] detail::moving_surface moving() noexcept {
        return {.positions = surface_.positions, .triangles = surface_.triangles, .rings = rings_, .clear = clear_, .kept = border_.kept()};
    }
    [[nodiscard]] std::uint64_t id_of(std::size_t i) const {
        if constexpr (requires { { fluid_.id(i) } -> std::same_as<std::uint64_t>; }) {
            return fluid_.id(i);
        } else {
            return i;
        }
    }

    template <executor Executor>
    void iterate(Executor const& threads) {
        if (!fresh_) {
            rings_ = vertex_rings(surface_.positions.size(), surface_.triangles);
            moves_.adopt(moving());
            border_.adopt(rings_, surface_.triangles, surface_.positions.size());
            clearance_.forget();
            fresh_ = true;
        }
        if (surface_.triangles.empty()) {
            report_.time += advanced(fluid_.step(open_space{}, threads));
            ++report_.iterations;
            return;
        }
        stand_walls();
        double const dt = ahead_ > 0 ? ahead_ : advanced(fluid_.step(walls_[0], threads));
        // What the user wrote may throw up to here and no further; the next run then goes on behind the fluid's step.
        ahead_ = dt;
        if (walls_[0].reach() != fluid_.reach()) stand_walls();
        double const most = mean_edge_ / options_.step_divisor;  // of the input: what grows or is split later changes no limit
        detail::volume_sum gone = 0;
        if constexpr (!detail::is_curvature_erosion<Process>) {
            gone = loads_now_.follow(books_.load, fluid_.particle_count(), [&](std::size_t i) { return id_of(i); });
        }
        contacts_.find(process_, fluid_, walls_[0], loads_now_, unit_, dt, threads);
        if constexpr (detail::is_curvature_erosion<Process>) {
            displacement_.find(process_, {.positions = surface_.positions, .triangles = surface_.triangles, .rings = &rings_},
                               border_.kept(), contacts_, mean_edge_, most, next_, threads);
        }
        if (options_.check_every > 0) look_around(most, threads);
        // Of what follows only memory may run out; the iteration is taken back then.
        keep();
        try {
            report_.time += dt;
            ++report_.iterations;
            report_.particles = fluid_.particle_count();
            wear(most, gone);
            if (options_.refine_length > 0 && report_.iterations % options_.refine_every == 0) refine();
        } catch (...) {
            take_back();
            throw;
        }
        ahead_ = 0;
    }

    [[nodiscard]] static double advanced(double dt) {
        if (dt > 0 && std::isfinite(dt)) return dt;
        detail::fail<invalid_input>(errc::bad_parameter, "hydraulic_run: the fluid advanced by " + detail::number_text(dt) + " s",
                                    {.kind = entity::parameter, .value = dt});
    }
    /// Where the surface is, and to the fluid's reach.
    void stand_walls() {
        if (!walls_.empty() && walls_[0].reach() == fluid_.reach()) return walls_[0].refit(surface_.positions, surface_.triangles);
        walls_.clear();
        walls_.emplace_back(surface_.positions, surface_.triangles, fluid_.reach());
    }

    void wear(double most, detail::volume_sum gone) {
        book_contacts(most);
        if constexpr (!detail::is_curvature_erosion<Process>) {
            books_.left += gone;
            std::swap(books_.load, loads_now_);
            settle_(moving(), moves_, exchange_, unit_, most, books_, wear_, sediment_);
        } else {
            detail::follow(moving(), next_, moves_, most);
            book_difference();
            for (std::size_t v = 0; v < next_.size(); ++v) wear_[v] += length(next_[v] - kept_.positions[v]);
        }
        report_.ledger = books_.in(unit_);
    }

    /// Gives a way to the vertices that may move in this iteration.
    template <executor Executor>
    void look_around(double most, Executor const& threads) {
        std::size_t const n = surface_.positions.size();
        bool const anew = clear_.size() != n || (report_.iterations % options_.check_every == 0 &&
                                                 (report_.iterations / options_.check_every % detail::most_looks_spared == 0 ||
                                                  detail::many_have_gone(clear_, given_)));
        if (anew) {
            given_.assign(n, 0.0);  // first: where memory runs out, the size of the other tells
            clear_.assign(n, -1.0);
        }
        wet_.assign(n, 0);
        if constexpr (!detail::is_curvature_erosion<Process>) {
            for (std::size_t v = 0; v < n; ++v) wet_[v] = books_.due[v] != 0 ? 1 : 0;
            contacts_.for_each([&](detail::water_contacts::contact const& c) {
                for (std::uint32_t const v : surface_.triangles[c.face]) wet_[v] = 1;
            });
            // What is due is passed on to neighbours before vertices move.
            for (std::size_t v = 0; v < n; ++v) {
                if ((wet_[v] & 1) == 0) continue;
                for (std::uint32_t const w : rings_.neighbors(v)) wet_[w] |= 2;
            }
        } else {
            for (std::size_t v = 0; v < n; ++v) wet_[v] = next_[v] == surface_.positions[v] ? 0 : 1;
        }
        movers_.clear();
        for (std::size_t v = 0; v < n; ++v) {
            if (wet_[v] != 0) movers_.push_back(static_cast<std::uint32_t>(v));
        }
        double const look = detail::most_looks_spared * static_cast<double>(options_.check_every) * most / detail::wall_clearance::share;
        std::erase_if(movers_, [&](std::uint32_t v) { return clear_[v] >= 0; });
        clearance_.find(moving(), movers_, look, clear_, threads);
        for (std::uint32_t const v : movers_) given_[v] = clear_[v];
    }

    void keep() {
        kept_.positions = surface_.positions;
        kept_.wear = wear_;
        kept_.flow = flow_;
        kept_.sediment = sediment_;
        kept_.books = books_;
        kept_.report = report_;
        kept_.clear = clear_;
        kept_.given = given_;
    }
    void take_back() noexcept {
        std::swap(surface_.positions, kept_.positions);
        std::swap(wear_, kept_.wear);
        std::swap(flow_, kept_.flow);
        std::swap(sediment_, kept_.sediment);
        std::swap(books_, kept_.books);
        std::swap(clear_, kept_.clear);
        std::swap(given_, kept_.given);
        report_ = kept_.report;
        fresh_ = false;
    }

    /// What the contacts ask for and get, less and less of it going round.
    void book_contacts(double most) {
        wet_.assign(surface_.positions.size(), 0);
        if constexpr (!detail::is_curvature_erosion<Process>) {
            exchange_.open(surface_.positions.size());
            contacts_.for_each([&](detail::water_contacts::contact const& c) { exchange_.ask(surface_.triangles[c.face], c.taken); });
            exchange_.close(moving(), moves_, unit_, most, books_);
        }
        contacts_.for_each([&](detail::water_contacts::contact const& c) {
            auto const& t = surface_.triangles[c.face];
            for (std::uint32_t const v : t) {
                ++flow_[v];
                wet_[v] = 1;
            }
            if constexpr (!detail::is_curvature_erosion<Process>) {
                std::int64_t& load = loads_now_.all()[c.particle].units;
                for (std::uint32_t const v : t) detail::give_back(moving(), v, books_.due[v], load);
                // What was not granted before cannot be laid down now.
                std::int64_t const taken = std::max(c.taken, -load);
                if (taken == 0) return;
                for (std::size_t k = 0; k < 3; ++k) {
                    std::int64_t const part = exchange_.grant(t[k], exchange_.third(taken, k));
                    books_.due[t[k]] -= part;
                    load += part;
                }
            }
        });
        report_.contacts += contacts_.count();
    }

    /// The volume that each face swept; water carries it all away. The sides of two faces at their edge are the same,
    /// so the sum is the volume between the surface before and `next_`, also where the surface is open.
    void book_difference() {
        auto const& was = kept_.positions;
        for (auto const& t : surface_.triangles) {
            bool same = true;
            for (std::uint32_t const c : t) same = same && next_[c] == was[c];
            if (same) continue;
            vec3 const areas = detail::swept_areas(t, was, next_);
            for (std::uint32_t const c : t) {
                std::int64_t const taken = unit_.fixed(dot(was[c] - next_[c], areas) / 36);  // by the corner that moved
                books_.eroded += taken;
                books_.left += taken;
                sediment_[c] -= taken;
            }
        }
    }

    /// Splits long edges of wet triangles.
    void refine() {
        auto const& p = surface_.positions;
        refined_faces fine = refine_edges(surface_, [&](std::uint32_t a, std::uint32_t b) {
            return (wet_[a] != 0 || wet_[b] != 0) && squared_length(p[a] - p[b]) > options_.refine_length * options_.refine_length;
        });
        if (fine.midpoints.empty()) return;
        refined_origins origins = origins_;
        origins.follow(fine);
        add_midpoints(surface_.positions, fine.midpoints);
        for (auto const& m : fine.midpoints) {
            wear_.push_back(0.5 * wear_[m[0]] + 0.5 * wear_[m[1]]);
            flow_.push_back(std::min(flow_[m[0]], flow_[m[1]]));
        }
        books_.due.resize(surface_.positions.size(), 0);
        sediment_.resize(surface_.positions.size(), 0);
        report_.vertices_added += fine.midpoints.size();
        clear_.clear();  // of the vertices before; `look_around` begins anew
        given_.clear();
        surface_.triangles = std::move(fine.triangles);  // last: `take_back` does not know the old ones, nor origins
        origins_ = std::move(origins);
        fresh_ = false;
    }

    /// What an iteration changes.
    struct before {
        std::vector<vec3> positions{};
        std::vector<double> wear{};
        std::vector<std::uint64_t> flow{};
        std::vector<std::int64_t> sediment{};
        detail::sediment_books books{};
        hydraulic_report report{};
        std::vector<double> clear{};
        std::vector<double> given{};
    };

    Process process_;
    hydraulic_options options_;
    Fluid fluid_;
    triangle_surface surface_;
    std::vector<vec3> input_;             ///< positions as given
    std::uint64_t input_hash_ = 0;
    std::size_t input_faces_ = 0;
    refined_origins origins_{};
    vertex_rings rings_{};
    bool fresh_ = false;
    double mean_edge_ = 0;                ///< of the input
    std::vector<mesh_boundary> walls_{};  ///< none or one
    detail::volume_unit unit_{};
    detail::sediment_books books_{};
    detail::sediment_exchange exchange_{};
    detail::sediment_settlement settle_{};
    detail::sound_moves moves_{};
    double ahead_ = 0;                    ///< s that the fluid is ahead of the surface by, after an exception
    detail::particle_loads loads_now_{};  ///< of the iteration under way
    detail::water_contacts contacts_{};
    detail::water_displacement displacement_{};
    before kept_{};
    detail::wall_clearance clearance_{};
    detail::held_borders border_{};
    std::vector<double> clear_{};         ///< way that vertices have to other walls, below 0 not known
    std::vector<double> given_{};         ///< that they had when it was found
    std::vector<std::uint32_t> movers_{};
    std::vector<unsigned char> wet_{};
    std::vector<vec3> next_{};
    std::vector<double> wear_{};
    std::vector<std::uint64_t> flow_{};
    std::vector<std::int64_t> sediment_{};
    hydraulic_report report_{};
};

}  // namespace tafoni

#endif
