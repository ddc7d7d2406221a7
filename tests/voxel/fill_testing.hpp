/// \file
/// What the tests of filling share: a user's own grid, and comparisons.
#ifndef TAFONI_TESTS_VOXEL_FILL_TESTING_HPP
#define TAFONI_TESTS_VOXEL_FILL_TESTING_HPP

#include <tafoni/core/random.hpp>
#include <tafoni/geometry/indexed_mesh.hpp>
#include <tafoni/voxel/concepts.hpp>
#include <tafoni/voxel/grid_frame.hpp>

#include <cstddef>
#include <vector>

namespace tafoni_test {

/// A grid that the library does not know: a vector, x fastest, everything colluvium at first.
struct plain_grid {
    explicit plain_grid(tafoni::grid_frame const& f) : frame(f), states(f.voxel_count(), tafoni::voxel_state::colluvium) {}
    tafoni::grid_frame frame;
    std::vector<tafoni::voxel_state> states;
    [[nodiscard]] std::size_t at(std::size_t i, std::size_t j, std::size_t k) const {
        return i + frame.size[0] * (j + frame.size[1] * k);
    }
};

template <tafoni::voxel_grid A, tafoni::voxel_grid B>
std::size_t differences(A const& a, B const& b) {
    auto const n = tafoni::grid_access<A>::size(a);
    std::size_t found = 0;
    for (std::size_t k = 0; k < n[2]; ++k) {
        for (std::size_t j = 0; j < n[1]; ++j) {
            for (std::size_t i = 0; i < n[0]; ++i) {
                if (tafoni::grid_access<A>::state(a, i, j, k) != tafoni::grid_access<B>::state(b, i, j, k)) ++found;
            }
        }
    }
    return found;
}

inline tafoni::indexed_mesh turned(tafoni::indexed_mesh m, tafoni::stream& random) {
    tafoni::vec3 const a = random.unit_vector();
    tafoni::vec3 const other = random.unit_vector();
    tafoni::vec3 const b = tafoni::normalized(tafoni::cross(a, other));
    tafoni::vec3 const c = tafoni::cross(a, b);
    for (tafoni::vec3& p : m.positions) p = tafoni::vec3(p[0] * a + p[1] * b + p[2] * c);
    return m;
}

}  // namespace tafoni_test

template <>
struct tafoni::grid_access<tafoni_test::plain_grid> {
    using grid = tafoni_test::plain_grid;
    static std::array<std::size_t, 3> size(grid const& g) { return g.frame.size; }
    static vec3 spacing(grid const& g) { return g.frame.spacing; }
    static vec3 origin(grid const& g) { return g.frame.origin; }
    static voxel_state state(grid const& g, std::size_t i, std::size_t j, std::size_t k) { return g.states[g.at(i, j, k)]; }
    static void set(grid& g, std::size_t i, std::size_t j, std::size_t k, voxel_state s) { g.states[g.at(i, j, k)] = s; }
};

#endif
