/// \file
/// Hydraulic erosion of a mesh by a particle fluid: the surface that wears, and the loop over the iterations.
#ifndef TAFONI_WEATHERING_HYDRAULIC_RUN_HPP
#define TAFONI_WEATHERING_HYDRAULIC_RUN_HPP

#include <tafoni/core/executor.hpp>
#include <tafoni/core/run_context.hpp>
#include <tafoni/curvature/displacement.hpp>
#include <tafoni/curvature/vertex_normals.hpp>
#include <tafoni/fluid/concepts.hpp>
#include <tafoni/fluid/detail/visit_order.hpp>
#include <tafoni/fluid/mesh_boundary.hpp>
#include <tafoni/geometry/refine_faces.hpp>
#include <tafoni/geometry/triangle_surface.hpp>
#include <tafoni/weathering/detail/near_water.hpp>
#include <tafoni/weathering/detail/sediment.hpp>
#include <tafoni/weathering/hydraulic_erosion.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <unordered_set>
#include <utility>
#include <vector>

namespace tafoni {

/// A surface under water [Skala's thesis, chapters 8 and 9]. Owns a copy of the mesh, and the fluid.
///
/// An iteration lets the fluid take a step along the surface, then wears the surface by the particles that touch
/// it. With an exchange rule each particle takes rate x contact area x time from the corners of its face or
/// lays down what it carries; the contact area is that of the circle in which the face cuts the ball of the
/// particle's reach, pi (reach^2 - distance^2). With `curvature_erosion` the vertices within the influence of a
/// particle that touches go by (1 - distance / influence) H^n e / x, never outwards. The state depends on
/// mesh, fluid, process and options only, never on threads.
template <hydraulic_process Process, particle_fluid Fluid>
class hydraulic_run {
public:
    /// O(vertices + faces). \throws invalid_input  for a mesh or parameters out of range.
    template <triangle_mesh M>
    hydraulic_run(M const& mesh, Fluid fluid, Process process, hydraulic_options const& options = {})
        : process_(std::move(process)), options_((options.validate(), options)), fluid_(std::move(fluid)),
          surface_(triangle_surface::copy_of(mesh)) {
        if constexpr (requires { process_.validate(); }) process_.validate();
        std::size_t const n = surface_.positions.size();
        books_.due.assign(n, 0);
        wear_.assign(n, 0.0);
        flow_.assign(n, 0);
        sediment_.assign(n, 0);
        box3 box;
        for (vec3 const& p : surface_.positions) box.include(p);
        vec3 const e = n > 0 ? box.extent() : vec3{1, 1, 1};
        double const side = std::max({e[0], e[1], e[2]});
        unit_ = detail::volume_unit(side * side * side);
    }

    /// Adds iterations. Progress under the stage "weather"; an observer's `stop` ends the run after an iteration.
    /// Where an observer, a rule, an estimator or the fluid throws, surface and report are those after the last whole
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
    [[nodiscard]] Fluid const& fluid() const noexcept { return fluid_; }
    [[nodiscard]] hydraulic_report const& report() const noexcept { return report_; }
    /// Way that each vertex has moved, length unit.
    [[nodiscard]] std::span<double const> wear() const noexcept { return wear_; }
    /// Particles that touched a face at the vertex, summed over iterations.
    [[nodiscard]] std::span<std::uint64_t const> flow() const noexcept { return flow_; }
    /// Volume laid down less volume taken, cubed length unit. O(vertices).
    [[nodiscard]] std::vector<double> sediment() const {
        std::vector<double> out(sediment_.size());
        for (std::size_t v = 0; v < out.size(); ++v) out[v] = unit_.volume(sediment_[v]);
        return out;
    }
    /// Whether eroded = deposited + carried + left, in whole units: always.
    [[nodiscard]] bool balanced() const noexcept { return books_.balanced(); }

private:
    struct contact {
        std::uint32_t face = 0;
        std::uint32_t load = 0;  ///< whose, among those of the block
        std::int64_t taken = 0;  ///< from the face; negative: laid down
    };
    struct block {
        std::vector<contact> contacts{};
        std::vector<vec3> points{};
        std::vector<std::pair<std::uint64_t, std::int64_t>> loads{};
    };
    static constexpr std::size_t particle_grain = 2048;

    [[nodiscard]] detail::moving_surface moving() noexcept {
        return {.positions = surface_.positions, .triangles = surface_.triangles, .rings = rings_};
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
            if (!(mean_edge_ > 0)) mean_edge_ = surface_.mean_edge_length();  // what grows or is split later changes no limit
            fresh_ = true;
        }
        if (surface_.triangles.empty()) {
            report_.time += fluid_.step(open_space{}, threads);
            ++report_.iterations;
            return;
        }
        if (walls_.empty()) {
            walls_.emplace_back(surface_.positions, surface_.triangles, fluid_.reach());
        } else {
            walls_[0].refit(surface_.positions, surface_.triangles);
        }
        double const dt = ahead_ > 0 ? ahead_ : fluid_.step(walls_[0], threads);
        if (!(dt > 0 && std::isfinite(dt))) {
            detail::fail<invalid_input>(errc::bad_parameter, "hydraulic_run: the fluid advanced by " + detail::number_text(dt) + " s",
                                        {.kind = entity::parameter, .value = dt});
        }
        // What the user wrote may throw up to here and no further; the next run then goes on behind the fluid's step.
        ahead_ = dt;
        double const most = mean_edge_ / options_.step_divisor;
        touch(dt, threads);
        if constexpr (!exchange_rule<Process>) displace(most, threads);
        ahead_ = 0;
        book_contacts(most);
        if constexpr (exchange_rule<Process>) {
            settle_(moving(), moves_, unit_, most, books_, wear_, sediment_);
        } else {
            before_ = surface_.positions;
            detail::follow(moving(), next_, moves_, most);
            book_difference();
            for (std::size_t v = 0; v < next_.size(); ++v) wear_[v] += length(next_[v] - before_[v]);
        }
        report_.time += dt;
        ++report_.iterations;
        report_.particles = fluid_.particle_count();
        report_.ledger = {.eroded = unit_.volume(books_.eroded), .deposited = unit_.volume(books_.deposited),
                          .carried = unit_.volume(books_.carried()), .left = unit_.volume(books_.left)};
        if (options_.refine_length > 0 && report_.iterations % options_.refine_every == 0) refine();
    }

    /// Who touches what; with an exchange rule also what is taken and laid down.
    template <executor Executor>
    void touch(double dt, Executor const& threads) {
        std::size_t const n = fluid_.particle_count();
        blocks_.assign((n + particle_grain - 1) / particle_grain, {});
        double const reach = fluid_.reach();
        order_.sort(walls_[0], n, [&](std::size_t i) { return fluid_.position(i); });
        threads.for_blocks(n, particle_grain, [&](std::size_t begin, std::size_t end) {
            block& out = blocks_[begin / particle_grain];
            for (std::size_t k = begin; k < end; ++k) {
                std::size_t const i = order_[k];
                vec3 const p = fluid_.position(i);
                bool touches = false;
                std::int64_t load = 0;
                bool known = false;
                walls_[0].for_each_contact(p, reach, [&](boundary_contact const& c) {
                    touches = true;
                    std::int64_t taken = 0;
                    if constexpr (exchange_rule<Process>) {
                        if (!known) {
                            auto const at = books_.load.find(id_of(i));
                            load = at == books_.load.end() ? 0 : at->second;
                            known = true;
                            out.loads.push_back({id_of(i), load});
                        }
                        wash_point const w{.position = p, .velocity = fluid_.velocity(i), .normal = c.normal,
                                           .distance = c.distance, .reach = reach};
                        double const rate = process_.rate(w);
                        if (!std::isfinite(rate)) {
                            detail::fail<invalid_input>(errc::bad_parameter, "hydraulic_run: the rule answers " + detail::number_text(rate),
                                                        {.kind = entity::parameter, .value = rate});
                        }
                        double const area = pi * std::max(reach * reach - c.distance * c.distance, 0.0);
                        taken = unit_.fixed(rate * area * dt);
                        if (taken < -load) taken = -load;
                        load += taken;
                    }
                    out.contacts.push_back({c.face, static_cast<std::uint32_t>(out.loads.size() - (known ? 1U : 0U)), taken});
                });
                if (touches) out.points.push_back(p);
            }
        });
        points_.clear();
        for (block const& b : blocks_) points_.insert(points_.end(), b.points.begin(), b.points.end());
    }

    void book_contacts(double most) {
        wet_.assign(surface_.positions.size(), 0);
        if constexpr (exchange_rule<Process>) {
            exchange_.open(surface_.positions.size());
            for (block const& b : blocks_) {
                for (contact const& c : b.contacts) exchange_.ask(surface_.triangles[c.face], c.taken);
            }
            exchange_.close(moving(), moves_, unit_, most, books_);
        }
        for (block& b : blocks_) {
            report_.contacts += b.contacts.size();
            for (contact const& c : b.contacts) {
                auto const& t = surface_.triangles[c.face];
                // What was not granted before cannot be laid down now.
                std::int64_t const taken = c.taken < 0 ? std::max(c.taken, -b.loads[c.load].second) : c.taken;
                for (std::size_t k = 0; k < 3; ++k) {
                    ++flow_[t[k]];
                    wet_[t[k]] = 1;
                    if (taken == 0) continue;
                    std::int64_t const part = exchange_.grant(t[k], exchange_.third(taken, k));
                    books_.due[t[k]] -= part;
                    b.loads[c.load].second += part;
                }
            }
            for (auto const& [id, load] : b.loads) {
                if (load == 0) {
                    books_.load.erase(id);
                } else {
                    books_.load[id] = load;
                }
            }
        }
        if (!books_.load.empty()) {
            std::size_t const n = fluid_.particle_count();
            std::unordered_set<std::uint64_t> alive;
            alive.reserve(n);
            for (std::size_t i = 0; i < n; ++i) alive.insert(id_of(i));
            books_.drop_gone([&](std::uint64_t id) { return alive.count(id) != 0; });
        }
    }

    /// Where curvature takes the vertices near the water to: `next_`.
    template <executor Executor>
    void displace(double most, Executor const& threads) {
        std::size_t const n = surface_.positions.size();
        double const influence = process_.influence > 0 ? process_.influence : mean_edge_;
        square_.resize(n);
        water_.find(points_, surface_.positions, influence, square_, threads);
        mean_.resize(n);
        normal_.resize(n);
        surface_view const view{.positions = surface_.positions, .triangles = surface_.triangles, .rings = &rings_};
        process_.estimator(view, std::span<double>(mean_), threads);
        vertex_normals(view, normal_, threads);
        double low = std::numeric_limits<double>::infinity();
        double high = -low;
        for (double const h : mean_) {
            low = std::min(low, h);
            high = std::max(high, h);
        }
        // Of one curvature everywhere: halfway between ridge and hollow.
        double const width = high > low ? 1 / (high - low) : 0.0;
        double const largest = std::max(std::fabs(low), std::fabs(high));
        next_ = surface_.positions;
        threads.for_blocks(n, detail::vertex_grain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t v = begin; v < end; ++v) {
                if (!(square_[v] <= influence * influence)) continue;
                double const share = width > 0 ? (mean_[v] - low) * width : 0.5;
                double const nearness = (influence - std::sqrt(square_[v])) / influence;
                vec3 const p = surface_.positions[v];
                vec3 const way = direction(v, largest > 0 ? mean_[v] / largest : 0.0);
                double const strength = process_.power == 1 ? share : share > 0 ? elementary::pow(share, process_.power) : 0.0;
                double const hard = std::max(process_.durability(p), 1e-3);
                double const d = std::min(strength / hard, 1.0) * most * nearness;
                next_[v] = vec3{p[0] + d * way[0], p[1] + d * way[1], p[2] + d * way[2]};
            }
        });
    }

    /// Equation 9.7 with the erratum: inward normal and unit Laplacian, without what would lead outwards.
    [[nodiscard]] vec3 direction(std::size_t v, double curvature) const {
        vec3 const& p = surface_.positions[v];
        vec3 laplacian{0, 0, 0};
        auto const around = rings_.neighbors(v);
        for (std::uint32_t const w : around) laplacian += surface_.positions[w] - p;
        if (!around.empty()) laplacian /= static_cast<double>(around.size());
        vec3 way = blended_direction{}.direction(
            {.position = p, .laplacian = laplacian, .normal = normal_[v], .curvature = curvature});
        double const out = dot(way, normal_[v]);
        if (out > 0) {
            for (int a = 0; a < 3; ++a) way[a] -= out * normal_[v][a];
        }
        return way;
    }

    /// The volume between `before_` and the surface, face by face; water carries it all away.
    void book_difference() {
        vec3 const o = before_.front();
        for (auto const& t : surface_.triangles) {
            bool same = true;
            for (std::uint32_t const c : t) same = same && next_[c] == before_[c];
            if (same) continue;
            auto const six = [&](std::vector<vec3> const& p) {
                return dot(p[t[0]] - o, cross(p[t[1]] - o, p[t[2]] - o));
            };
            std::int64_t const taken = unit_.fixed((six(before_) - six(next_)) / 6);
            books_.eroded += taken;
            books_.left += taken;
            sediment_[t[0]] -= taken;
        }
    }

    /// Splits long edges of wet triangles.
    void refine() {
        auto const& p = surface_.positions;
        refined_faces fine = refine_edges(surface_, [&](std::uint32_t a, std::uint32_t b) {
            return (wet_[a] != 0 || wet_[b] != 0) && squared_length(p[a] - p[b]) > options_.refine_length * options_.refine_length;
        });
        if (fine.midpoints.empty()) return;
        add_midpoints(surface_.positions, fine.midpoints);
        for (auto const& m : fine.midpoints) {
            wear_.push_back(0.5 * wear_[m[0]] + 0.5 * wear_[m[1]]);
            flow_.push_back(std::min(flow_[m[0]], flow_[m[1]]));
        }
        surface_.triangles = std::move(fine.triangles);
        books_.due.resize(surface_.positions.size(), 0);
        sediment_.resize(surface_.positions.size(), 0);
        report_.vertices_added += fine.midpoints.size();
        fresh_ = false;
    }

    static constexpr double pi = 3.14159265358979323846;

    Process process_;
    hydraulic_options options_;
    Fluid fluid_;
    triangle_surface surface_;
    vertex_rings rings_{};
    bool fresh_ = false;
    double mean_edge_ = 0;
    std::vector<mesh_boundary> walls_{};  ///< none or one
    detail::near_water water_{};
    detail::volume_unit unit_{};
    detail::sediment_books books_{};
    detail::sediment_exchange exchange_{};
    detail::sediment_settlement settle_{};
    detail::sound_moves moves_{};
    double ahead_ = 0;                    ///< s that the fluid is ahead of the surface by, after an exception
    std::vector<block> blocks_{};
    detail::visit_order order_{};
    std::vector<vec3> points_{};          ///< particles that touch
    std::vector<unsigned char> wet_{};
    std::vector<double> square_{};
    std::vector<double> mean_{};
    std::vector<vec3> normal_{};
    std::vector<vec3> next_{};
    std::vector<vec3> before_{};
    std::vector<double> wear_{};
    std::vector<std::uint64_t> flow_{};
    std::vector<std::int64_t> sediment_{};
    hydraulic_report report_{};
};

}  // namespace tafoni

#endif
