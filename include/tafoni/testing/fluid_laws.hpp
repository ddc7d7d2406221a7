/// \file
/// Law checks for particle fluids and for the walls that they flow against.
#ifndef TAFONI_TESTING_FLUID_LAWS_HPP
#define TAFONI_TESTING_FLUID_LAWS_HPP

#include <tafoni/core/detail/bytes.hpp>
#include <tafoni/fluid/mesh_boundary.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

namespace tafoni::laws {

namespace detail {

/// Runs blocks from the last to the first and says that it has several threads.
struct last_block_first {
    template <class F>
    void for_blocks(std::size_t n, std::size_t grain, F const& f) const {
        if (grain == 0) grain = 1;
        for (std::size_t b = (n + grain - 1) / grain * grain; b >= grain; b -= grain) f(b - grain, std::min(b, n));
    }
    [[nodiscard]] std::size_t thread_count() const noexcept { return 4; }
};

}  // namespace detail

/// Particle fluid: what the concept's comment asks for, over a few steps from the state that is given, in open space
/// and over a floor in the plane z = `floor`. Returns the broken laws.
template <particle_fluid Fluid>
    requires std::copy_constructible<Fluid>
[[nodiscard]] std::vector<std::string> fluid(Fluid const& start, double floor = 0, int steps = 20) {
    std::vector<std::string> broken;
    auto const law = [&](bool holds, char const* what) {
        if (!holds && std::find(broken.begin(), broken.end(), what) == broken.end()) broken.push_back(what);
    };
    law(start.reach() > 0 && std::isfinite(start.reach()), "the reach is positive");
    double const wide = 1e3 * start.reach();
    std::vector<vec3> const corners{vec3{-wide, -wide, floor}, vec3{wide, -wide, floor}, vec3{wide, wide, floor}, vec3{-wide, wide, floor}};
    std::vector<std::array<std::uint32_t, 3>> const faces{{0, 1, 2}, {0, 2, 3}};
    mesh_boundary const ground(corners, faces, start.reach());
    auto const same = [](Fluid const& a, Fluid const& b) {
        if (a.particle_count() != b.particle_count()) return false;
        for (std::size_t i = 0; i < a.particle_count(); ++i) {
            if (a.position(i) != b.position(i) || a.velocity(i) != b.velocity(i)) return false;
        }
        return true;
    };
    auto const run = [&](auto const& walls) {
        Fluid one(start);
        Fluid two(start);
        for (int k = 0; k < steps; ++k) {
            double const dt = one.step(walls, inline_executor{});
            law(dt > 0 && std::isfinite(dt), "a step takes time");
            law(two.step(walls, detail::last_block_first{}) == dt && same(one, two), "equal for every executor");
            law(same(one, one), "nothing changes between two steps");
            std::set<std::uint64_t> ids;
            for (std::size_t i = 0; i < one.particle_count(); ++i) {
                law(is_finite(one.position(i)) && is_finite(one.velocity(i)), "positions and velocities are finite");
                if constexpr (requires { { one.id(i) } -> std::same_as<std::uint64_t>; }) ids.insert(one.id(i));
            }
            if constexpr (requires { one.id(std::size_t{}); }) {
                law(ids.size() == one.particle_count(), "no two particles have one id");
            }
        }
    };
    run(open_space{});
    run(ground);
    if constexpr (requires(tafoni::detail::byte_writer& out, tafoni::detail::byte_reader& in, Fluid& f) { f.save(out); f.load(in); }) {
        Fluid one(start);
        Fluid two(start);
        for (int k = 0; k < steps; ++k) static_cast<void>(one.step(ground, inline_executor{}));
        tafoni::detail::byte_writer out;
        one.save(out);
        tafoni::detail::byte_reader in(out.bytes(), "laws::fluid");
        two.load(in);
        law(in.left() == 0, "load reads as much as save wrote");
        law(same(one, two) && one.step(ground, inline_executor{}) == two.step(ground, inline_executor{}) && same(one, two),
            "a saved fluid goes on as if it had not been");
    }
    return broken;
}

/// Walls: what the concept's comment asks for, at the places that are given. Returns the broken laws.
template <fluid_boundary Boundary>
[[nodiscard]] std::vector<std::string> boundary(Boundary const& walls, std::vector<vec3> const& places, double radius) {
    std::vector<std::string> broken;
    auto const law = [&](bool holds, char const* what) {
        if (!holds && std::find(broken.begin(), broken.end(), what) == broken.end()) broken.push_back(what);
    };
    for (vec3 const& p : places) {
        std::vector<boundary_contact> first;
        std::vector<boundary_contact> second;
        walls.for_each_contact(p, radius, [&](boundary_contact const& c) { first.push_back(c); });
        walls.for_each_contact(p, radius, [&](boundary_contact const& c) { second.push_back(c); });
        law(first.size() == second.size(), "pure: equal questions get equal answers");
        for (std::size_t k = 0; k < first.size(); ++k) {
            law(std::fabs(first[k].distance) <= radius * (1 + 1e-9), "no contact is farther than the radius");
            law(std::fabs(length(first[k].normal) - 1) <= 1e-9, "normals have unit length");
            if (k > 0) law(first[k - 1].face < first[k].face, "faces ascend");
            if (k < second.size()) {
                law(first[k].face == second[k].face && first[k].distance == second[k].distance, "pure: equal questions get equal answers");
            }
        }
    }
    return broken;
}

}  // namespace tafoni::laws

#endif
