#ifndef TAFONI_TESTS_PAPER_VOXEL_SCENE_HPP
#define TAFONI_TESTS_PAPER_VOXEL_SCENE_HPP

#include <tafoni/voxel/sparse_grid.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tafoni_test {

/// Air on five sides, ground below.
inline constexpr tafoni::grid_border on_ground{{tafoni::border_kind::air, tafoni::border_kind::air,
                                                tafoni::border_kind::air, tafoni::border_kind::air,
                                                tafoni::border_kind::rock, tafoni::border_kind::air}};

/// Sets the voxels from `low` to before `end`.
inline void fill_box(tafoni::sparse_grid& g, tafoni::voxel low, tafoni::voxel end,
                     tafoni::voxel_state as = tafoni::voxel_state::rock) {
    for (std::int32_t z = low.z; z < end.z; ++z) {
        for (std::int32_t y = low.y; y < end.y; ++y) {
            for (std::int32_t x = low.x; x < end.x; ++x) g.set({x, y, z}, as);
        }
    }
}

/// A round column that stands on the ground in the middle of the grid.
inline tafoni::sparse_grid column(int wide, int high, double radius) {
    auto const n = static_cast<std::size_t>(wide);
    tafoni::sparse_grid g({.size = {n, n, static_cast<std::size_t>(high) + 8}}, tafoni::up_axis::plus_z, on_ground);
    double const middle = wide / 2.0;
    for (std::size_t b = 0; b < g.brick_count(); ++b) {
        g.fill_brick(b, [&](tafoni::voxel v) {
            double const x = v.x + 0.5 - middle;
            double const y = v.y + 0.5 - middle;
            return v.z < high && x * x + y * y < radius * radius ? tafoni::voxel_state::rock : tafoni::voxel_state::air;
        });
    }
    return g;
}

/// Radius of the disc of as much rock as there is at each height.
inline std::vector<double> profile(tafoni::sparse_grid const& g) {
    std::vector<double> out;
    for (std::int32_t z = 0; z < static_cast<std::int32_t>(g.size()[2]); ++z) {
        double area = 0;
        for (std::int32_t y = 0; y < static_cast<std::int32_t>(g.size()[1]); ++y) {
            for (std::int32_t x = 0; x < static_cast<std::int32_t>(g.size()[0]); ++x) area += g.is_rock({x, y, z}) ? 1 : 0;
        }
        out.push_back(std::sqrt(area / 3.14159265358979));
    }
    return out;
}

/// Pearson's correlation.
inline double correlation(std::vector<double> const& a, std::vector<double> const& b) {
    double const n = static_cast<double>(a.size());
    double ma = 0;
    double mb = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        ma += a[i] / n;
        mb += b[i] / n;
    }
    double ab = 0;
    double aa = 0;
    double bb = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        ab += (a[i] - ma) * (b[i] - mb);
        aa += (a[i] - ma) * (a[i] - ma);
        bb += (b[i] - mb) * (b[i] - mb);
    }
    return ab / std::sqrt(aa * bb);
}

}  // namespace tafoni_test

#endif
