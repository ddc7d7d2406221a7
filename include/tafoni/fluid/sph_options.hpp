/// \file
/// What the particle fluid `sph` is told.
#ifndef TAFONI_FLUID_SPH_OPTIONS_HPP
#define TAFONI_FLUID_SPH_OPTIONS_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/core/vector.hpp>

#include <cstdint>
#include <limits>

namespace tafoni {

/// Lengths in the model's unit. Density cancels out of every acceleration, so there is none to give.
struct sph_options {
    std::uint32_t particles = 10000;  ///< most that are under way, 0 .. 2^24; emitters wait for a free one
    double spacing = 1;               ///< of particles at rest, length unit, > 0
    double smoothing = 1;             ///< h over spacing, in [0.9, 1.6]; the kernel ends at 2 h
    double sound_speed = 0;           ///< c, length unit / s; density varies by about (v / c)^2.
                                      ///< 0 = 10 times the speed of a fall through 16 spacings, or out of an emitter
    double viscosity = 1e-6;          ///< kinematic, length unit^2 / s, >= 0
    double damping = 0.1;             ///< artificial viscosity alpha [Monaghan 2005]: alpha h c / 10 on top, in [0, 10]
    double reach = 0;                 ///< at which a particle touches a wall, length unit; 0 = spacing
    double wall_stiffness = 0;        ///< k_s, acceleration per length of penetration, 1/s^2; 0 = (c / (5 reach))^2
    double wall_damping = 0;          ///< k_d, acceleration per velocity, 1/s; 0 = c / (5 reach)
    double friction = 0;              ///< share of its velocity that a particle at a wall loses per second, 1/s, in [0, 1e6].
                                      ///< 0 = smooth: streams on slopes grow ever faster and leap; sqrt(g / spacing) / 4
                                      ///< makes one on a slope run at a Froude number of 4 sin(slope)
    vec3 gravity{0, 0, -9.81};        ///< length unit / s^2
    vec3 centre{0, 0, 0};             ///< that `toward` pulls to
    double toward = 0;                ///< acceleration towards the centre, the same at every distance, length unit / s^2
    double courant = 0.8;             ///< step over h / (c + v), in (0, 1]; still water heats up from 1.5 on
    double largest_step = 0.05;       ///< s, > 0
    double frame = 0;                 ///< s that `step` advances by, in as many stable steps as it takes; 0 = one stable step

    /// Calls `out.add` with each number in turn: what a saved fluid is compared by.
    void describe(auto& out) const {
        out.add(std::uint64_t{particles});
        for (double const v : {spacing, smoothing, sound_speed, viscosity, damping, reach, wall_stiffness, wall_damping}) out.add(v);
        out.add(gravity);
        out.add(centre);
        for (double const v : {toward, courant, largest_step, frame}) out.add(v);
        if (friction > 0) out.add(friction);  // without, saves are those of versions that had none
    }

    /// \throws invalid_input  `bad_parameter`.
    void validate() const {
        constexpr double least = 1e-100;
        detail::require_range("sph_options.particles", particles, 0, 1u << 24);
        detail::require_range("sph_options.spacing", spacing, least, 1e100);
        detail::require_range("sph_options.smoothing", smoothing, 0.9, 1.6);
        detail::require_range("sph_options.sound_speed", sound_speed, 0, 1e100);
        detail::require_range("sph_options.viscosity", viscosity, 0, 1e100);
        detail::require_range("sph_options.damping", damping, 0, 10);
        detail::require_range("sph_options.reach", reach, 0, 1e100);
        detail::require_range("sph_options.wall_stiffness", wall_stiffness, 0, 1e100);
        detail::require_range("sph_options.wall_damping", wall_damping, 0, 1e100);
        detail::require_range("sph_options.friction", friction, 0, 1e6);
        for (int d = 0; d < 3; ++d) detail::require_range("sph_options.gravity", gravity[d], -1e100, 1e100);
        for (int d = 0; d < 3; ++d) detail::require_range("sph_options.centre", centre[d], -1e100, 1e100);
        detail::require_range("sph_options.toward", toward, -1e100, 1e100);
        detail::require_range("sph_options.courant", courant, 1e-6, 1);
        detail::require_range("sph_options.largest_step", largest_step, 1e-30, 1e30);
        detail::require_range("sph_options.frame", frame, 0, 1e30);
    }
};

}  // namespace tafoni

#endif
