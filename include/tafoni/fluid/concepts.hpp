/// \file
/// Particle fluids, and what they flow against.
#ifndef TAFONI_FLUID_CONCEPTS_HPP
#define TAFONI_FLUID_CONCEPTS_HPP

#include <tafoni/core/executor.hpp>
#include <tafoni/core/vector.hpp>

#include <concepts>
#include <cstddef>
#include <cstdint>

namespace tafoni {

/// A place on the boundary that a particle is close to.
struct boundary_contact {
    std::uint32_t face = 0;
    vec3 normal{0, 0, 0};  ///< of the face, unit, out of the solid
    double distance = 0;   ///< of the particle from the face, length unit; negative behind it, inside the solid
};

namespace detail {
struct contact_archetype {
    void operator()(boundary_contact const& contact) const;
};
}  // namespace detail

/// What a fluid asks about walls.
///
/// Laws: pure between two changes of the mesh; calls `visit` by ascending face number for each face that the
/// particle stands over: whose plane is at most `radius` away and that the foot of the normal meets [thesis, 8.1];
/// where there is none, for the nearest face within `radius`, if any, with the way from there as the normal.
/// May be asked by several threads at once.
template <class B>
concept fluid_boundary = requires(B const& b, vec3 const& p, double radius, detail::contact_archetype const& visit) {
    { b.for_each_contact(p, radius, visit) } -> std::same_as<void>;
};

/// No walls at all. Models `fluid_boundary`.
struct open_space {
    template <class Visit>
    void for_each_contact(vec3 const&, double, Visit const&) const noexcept {}
};
static_assert(fluid_boundary<open_space>);

/// A fluid of particles that advances by steps of its own choice.
///
/// Laws: `step(walls, threads)` advances by the returned time, in seconds, > 0, the same for every executor;
/// positions and velocities are finite; `reach()` > 0 is the distance, in length units, within which a particle
/// touches the boundary; between two steps nothing changes. Where a particle's number may change from step to
/// step, `std::uint64_t id(std::size_t) const` gives one that lasts; without it numbers last.
/// Model: `struct mine { std::size_t particle_count() const; vec3 position(std::size_t) const; vec3 velocity(std::size_t) const;
///             double reach() const; double step(fluid_boundary auto const&, executor auto const&); };`
template <class F>
concept particle_fluid = requires(F& f, F const& c, std::size_t i, open_space const& walls, inline_executor const& x) {
    { c.particle_count() } -> std::same_as<std::size_t>;
    { c.position(i) } -> std::same_as<vec3>;
    { c.velocity(i) } -> std::same_as<vec3>;
    { c.reach() } -> std::same_as<double>;
    { f.step(walls, x) } -> std::same_as<double>;
};

}  // namespace tafoni

#endif
