/// \file
/// The least particle fluid, the least walls, and the least rule for what water takes, that satisfy their concepts.
#ifndef TAFONI_TESTING_FLUID_ARCHETYPES_HPP
#define TAFONI_TESTING_FLUID_ARCHETYPES_HPP

#include <tafoni/fluid/concepts.hpp>
#include <tafoni/weathering/hydraulic_erosion.hpp>

#include <cstddef>

namespace tafoni::archetypes {

/// Three particles in a row that slide along x and heed no wall. No ids; copyable by construction only.
struct fluid {
    explicit fluid(int) {}
    fluid(fluid const&) = default;
    fluid& operator=(fluid const&) = delete;
    [[nodiscard]] std::size_t particle_count() const { return 3; }
    [[nodiscard]] vec3 position(std::size_t i) const { return vec3{time_, 0.4 * static_cast<double>(i), 0.1}; }
    [[nodiscard]] vec3 velocity(std::size_t) const { return vec3{1, 0, 0}; }
    [[nodiscard]] double reach() const { return 0.25; }
    double step(fluid_boundary auto const&, executor auto const&) {
        time_ += 0.125;
        return 0.125;
    }

private:
    double time_ = 0;
};

/// The half space below z = 0, as one face.
struct boundary {
    explicit boundary(int) {}
    boundary(boundary const&) = delete;
    boundary& operator=(boundary const&) = delete;
    template <class Visit>
    void for_each_contact(vec3 const& p, double radius, Visit const& visit) const {
        if (p[2] <= radius && p[2] >= -radius) visit(boundary_contact{.face = 0, .normal = vec3{0, 0, 1}, .distance = p[2]});
    }
};

/// Takes a millimetre of rock in ten seconds, whatever flows. Copyable by construction only.
struct exchange {
    explicit exchange(int) {}
    exchange(exchange const&) = default;
    exchange& operator=(exchange const&) = delete;
    [[nodiscard]] double rate(wash_point const&) const { return 1e-4; }
};

static_assert(particle_fluid<fluid> && fluid_boundary<boundary> && exchange_rule<exchange>);

}  // namespace tafoni::archetypes

#endif
