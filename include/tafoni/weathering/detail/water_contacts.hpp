/// \file
/// Which particles touch which faces, and what an exchange rule makes of it.
#ifndef TAFONI_WEATHERING_DETAIL_WATER_CONTACTS_HPP
#define TAFONI_WEATHERING_DETAIL_WATER_CONTACTS_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/core/executor.hpp>
#include <tafoni/fluid/detail/visit_order.hpp>
#include <tafoni/fluid/facing_contacts.hpp>
#include <tafoni/fluid/mesh_boundary.hpp>
#include <tafoni/weathering/detail/particle_loads.hpp>
#include <tafoni/weathering/detail/sediment.hpp>
#include <tafoni/weathering/hydraulic_erosion.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tafoni::detail {

/// The contacts of one iteration, in blocks of particles that lie side by side; keeps its memory from use to use.
class water_contacts {
public:
    struct contact {
        std::uint32_t face = 0;
        std::uint32_t particle = 0;
        std::int64_t taken = 0;  ///< from the face; negative: laid down
    };

    /// O(particles x faces near one). \throws invalid_input  where a rule's answer is not finite.
    template <class Process, class Fluid, executor E>
    void find(Process const& process, Fluid const& fluid, mesh_boundary const& walls, particle_loads const& loads,
              volume_unit const& unit, double dt, E const& threads) {
        order_.sort(walls, fluid.particle_count(), [&](std::size_t i) { return fluid.position(i); }, threads);
        std::size_t const away = order_.away();
        std::size_t const n = fluid.particle_count() - away;
        used_ = (n + grain - 1) / grain;
        if (blocks_.size() < used_) blocks_.resize(used_);
        double const reach = fluid.reach();
        threads.for_blocks(n, grain, [&](std::size_t begin, std::size_t end) {
            block& out = blocks_[begin / grain];
            out.contacts.clear();
            out.points.clear();
            for (std::size_t k = begin; k < end; ++k) {
                order_.look_ahead(walls, away + k);
                std::size_t const i = order_[away + k];
                vec3 const p = fluid.position(i);
                std::size_t const before = out.contacts.size();
                std::int64_t load = 0;
                for_each_facing_contact(walls, p, reach, [&](boundary_contact const& c) {
                    std::int64_t taken = 0;
                    if constexpr (!is_curvature_erosion<Process>) {
                        if (out.contacts.size() == before) load = loads.all()[i].units;
                        taken = exchanged(process, {.position = p, .velocity = fluid.velocity(i), .normal = c.normal,
                                                    .distance = c.distance, .reach = reach}, unit, dt);
                        taken = std::clamp(taken, -load, most_load - load);
                        load += taken;
                    }
                    out.contacts.push_back({c.face, static_cast<std::uint32_t>(i), taken});
                });
                if (out.contacts.size() != before) out.points.push_back(p);
            }
        });
        points_.clear();
        for (std::size_t b = 0; b < used_; ++b) points_.insert(points_.end(), blocks_[b].points.begin(), blocks_[b].points.end());
    }

    /// In an order that depends on the mesh and the particles only.
    template <class F>
    void for_each(F const& f) const {
        for (std::size_t b = 0; b < used_; ++b) {
            for (contact const& c : blocks_[b].contacts) f(c);
        }
    }
    [[nodiscard]] std::size_t count() const noexcept {
        std::size_t n = 0;
        for (std::size_t b = 0; b < used_; ++b) n += blocks_[b].contacts.size();
        return n;
    }
    /// Particles that touch.
    [[nodiscard]] std::span<vec3 const> points() const noexcept { return points_; }

private:
    static constexpr std::size_t grain = 256;
    static constexpr std::int64_t most_load = std::int64_t{1} << 60;  ///< that a particle carries, units
    static constexpr double pi = 3.14159265358979323846;

    struct block {
        std::vector<contact> contacts{};
        std::vector<vec3> points{};
    };

    /// Rate x contact area x time.
    template <class Process>
    [[nodiscard]] static std::int64_t exchanged(Process const& process, wash_point const& at, volume_unit const& unit, double dt) {
        double const rate = process.rate(at);
        if (!std::isfinite(rate)) {
            fail<invalid_input>(errc::bad_parameter, "hydraulic_run: the rule answers " + number_text(rate), {.kind = entity::parameter, .value = rate});
        }
        double const area = pi * std::max(at.reach * at.reach - at.distance * at.distance, 0.0);
        return unit.fixed(rate * area * dt);
    }

    visit_order order_{};
    std::size_t used_ = 0;  ///< of the blocks
    std::vector<block> blocks_{};
    std::vector<vec3> points_{};
};

}  // namespace tafoni::detail

#endif
