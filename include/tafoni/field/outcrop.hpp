/// \file
/// A rock that needs no file: an outcrop with ledges and an overhanging front.
#ifndef TAFONI_FIELD_OUTCROP_HPP
#define TAFONI_FIELD_OUTCROP_HPP

#include <tafoni/core/elementary.hpp>
#include <tafoni/core/random.hpp>
#include <tafoni/field/fractal_noise.hpp>
#include <tafoni/geometry/indexed_mesh.hpp>

#include <algorithm>
#include <vector>

namespace tafoni {

namespace detail {

/// Radius and height over the half-planes around the axis x = y = 0, in metres.
///
/// In every half-plane the flank is a graph over the height and the top a graph over the radius, no
/// lower than the rim where they meet: so the surface cannot cut itself.
struct outcrop_shape {
    fractal_noise relief;  // blocks and cracks of the flank
    fractal_noise bedding;  // where the beds begin
    fractal_noise crown;   // the top
    fractal_noise joints;  // upright clefts

    explicit outcrop_shape(std::uint64_t seed)
        : relief{.seed = seed, .frequency = 0.28, .octaves = 5, .gain = 0.45},
          bedding{.seed = seed + 1, .frequency = 0.25, .octaves = 2},
          crown{.seed = seed + 2, .frequency = 0.6, .octaves = 4},
          joints{.seed = seed + 3, .frequency = 0.45, .octaves = 2} {}

    [[nodiscard]] static double smooth(double t) noexcept {
        t = std::clamp(t, 0.0, 1.0);
        return t * t * (3 - 2 * t);
    }

    /// Height of the rim, 3.4 to 4.6 m: the outcrop is higher at its front (-y) than at its back.
    [[nodiscard]] double rim(vec3 const& out) const noexcept {
        return 4.0 - 0.3 * out[1] + 0.25 * crown(vec3{2 * out[0], 2 * out[1], 0});
    }

    /// Distance from the axis at the share t in [0, 1] of the rim's height.
    [[nodiscard]] double flank(vec3 const& out, double t) const noexcept {
        double const z = t * rim(out);
        double const plan = 1 / std::sqrt(out[0] * out[0] / (3.0 * 3.0) + out[1] * out[1] / (2.2 * 2.2));
        double const front = smooth(0.55 - 0.8 * out[1]);
        vec3 const at{plan * out[0], plan * out[1], z};
        // The back is a slope, the front a wall that hangs over a niche.
        double const slope = 0.95 - 0.2 * t;
        double const niche = smooth((t + 0.25) / 0.4) * smooth((0.62 - t) / 0.25);
        double const wall = 0.94 - 0.17 * niche * (1 + 0.6 * bedding(vec3{at[0] + 9, at[1], at[2]})) - 0.1 * smooth((t - 0.85) / 0.15);
        // Beds of uneven thickness stick out by uneven amounts, and not all the way around.
        double const bed = (z + 0.45 * bedding(at)) / 0.95;
        double const in_bed = bed - std::floor(bed);
        double const strength = 0.5 + 0.9 * bedding(vec3{at[0], at[1], 3 * std::floor(bed)});
        double const ledge = 0.1 * std::max(strength, 0.0) * (smooth(in_bed / 0.12) - in_bed);
        // Joints: upright clefts where a noise crosses zero.
        double const cleft = 1 - std::min(1.0, 14 * std::fabs(joints(vec3{at[0], at[1], 0.25 * z})));
        // Between joints and beds the rock stands in blocks, some further out than others.
        auto const cell = [](double x) { return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(x)) + 1000); };
        double const bend = 0.5 * bedding(vec3{at[1], at[0], 0.5 * z});
        stream random(relief.seed, stage::user, cell(at[0] / 1.1 + bend) + (cell(at[1] / 1.1 - bend) << 16) + (cell(bed) << 32));
        double const block = 0.09 * random.uniform(-1, 1);
        double const r = plan * (slope + front * (wall - slope) + block + ledge - 0.07 * cleft + 0.34 * relief(at));
        return std::max(r, 0.35);
    }

    /// Height of the top at the share u in [0, 1] of the rim's radius; the crown's middle is the same
    /// for every direction.
    [[nodiscard]] double top(vec3 const& out, double u) const noexcept {
        double const edge = rim(out);
        double const radius = u * flank(out, 1);
        double const bump = 0.25 + 0.25 * crown(vec3{radius * out[0], radius * out[1], 7});
        double const dome = smooth(1.6 * (1 - u));
        // The highest rim is 4.55: a crown of 4.6 stays above every rim.
        return edge + dome * (4.6 - edge) + bump * smooth(4 * (1 - u)) * smooth(4 * u);
    }
};

}  // namespace detail

/// A procedural outcrop about 6 m wide, 5 m deep and 4.6 m high, standing on z = 0, z up: a wall with
/// ledges and an overhang in front (-y), a slope behind.
///
/// Closed, outward oriented, embedded, quads and two fans of triangles. `resolution` in 4 .. 2000 is
/// the number of rings up the flank; there are about 5 resolution^2 faces. Depends on the arguments only. O(faces).
/// \throws invalid_input  `bad_parameter`.
[[nodiscard]] inline indexed_mesh make_outcrop(std::uint64_t seed = 1, std::size_t resolution = 40) {
    detail::require_range("make_outcrop.resolution", static_cast<double>(resolution), 4, 2000);
    detail::outcrop_shape const shape(seed);
    std::size_t const around = 4 * resolution;
    std::size_t const up = resolution;
    std::size_t const over = resolution / 2;
    std::vector<vec3> directions;
    for (std::size_t i = 0; i < around; ++i) {
        double const angle = 6.283185307179586 * static_cast<double>(i) / static_cast<double>(around);
        directions.push_back(vec3{elementary::cos(angle), elementary::sin(angle), 0});
    }
    indexed_mesh mesh;
    auto const ring = [&](auto const& place) {
        for (vec3 const& out : directions) mesh.add_vertex(place(out));
    };
    for (std::size_t k = 0; k <= up; ++k) {
        double const t = static_cast<double>(k) / static_cast<double>(up);
        ring([&](vec3 const& out) {
            double const r = shape.flank(out, t);
            return vec3{r * out[0], r * out[1], t * shape.rim(out)};
        });
    }
    for (std::size_t k = 1; k < over; ++k) {
        double const u = 1 - static_cast<double>(k) / static_cast<double>(over);
        ring([&](vec3 const& out) {
            double const r = u * shape.flank(out, 1);
            return vec3{r * out[0], r * out[1], shape.top(out, u)};
        });
    }
    std::size_t const rings = up + over;
    auto const at = [&](std::size_t row, std::size_t i) { return static_cast<std::uint32_t>(row * around + i % around); };
    auto const bottom = mesh.add_vertex(vec3{0, 0, 0}).value;
    auto const summit = mesh.add_vertex(vec3{0, 0, 4.6}).value;
    for (std::size_t i = 0; i < around; ++i) {
        mesh.add_face({bottom, at(0, i + 1), at(0, i)});
        for (std::size_t row = 0; row + 1 < rings; ++row) {
            mesh.add_face({at(row, i), at(row, i + 1), at(row + 1, i + 1), at(row + 1, i)});
        }
        mesh.add_face({at(rings - 1, i), at(rings - 1, i + 1), summit});
    }
    return mesh;
}

}  // namespace tafoni

#endif
