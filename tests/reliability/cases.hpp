/// \file
/// Random models for property tests and fuzz targets: a solid, sites and options, chosen by a stream or by bytes.
#ifndef TAFONI_TESTS_RELIABILITY_CASES_HPP
#define TAFONI_TESTS_RELIABILITY_CASES_HPP

#include "support/shapes.hpp"
#include "support/shard_laws.hpp"

#include <tafoni/core/random.hpp>
#include <tafoni/decomposition/sites.hpp>
#include <tafoni/decomposition/voronoi_shards.hpp>
#include <tafoni/geometry/make_solid.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tafoni_test {

/// Answers questions from bytes while there are any, then from a stream.
class choices {
public:
    explicit choices(std::uint64_t seed) : random_(seed, tafoni::stage::user, 1) {}
    explicit choices(std::span<unsigned char const> bytes) : bytes_(bytes), random_(bytes.size(), tafoni::stage::user, 2) {}

    [[nodiscard]] std::uint64_t below(std::uint64_t n) {
        if (at_ < bytes_.size() && n <= 256) return bytes_[at_++] % n;
        return random_.index_below(n);
    }
    /// In [0, 1); of bytes only 256 values, so that coincidences happen.
    [[nodiscard]] double unit() {
        if (at_ < bytes_.size()) return bytes_[at_++] / 256.0;
        return random_.uniform01();
    }
    [[nodiscard]] double between(double lo, double hi) { return lo + (hi - lo) * unit(); }
    [[nodiscard]] bool chance(double p) { return unit() < p; }

private:
    std::span<unsigned char const> bytes_{};
    std::size_t at_ = 0;
    tafoni::stream random_;
};

/// A small solid of a random kind, where `embedded` says whether its surface surely does not cut itself.
struct random_body {
    indexed_mesh mesh{};
    bool embedded = true;
    std::string name{};
    double rounding = 0;  ///< of coordinates, relative to the size, because of the place
};

[[nodiscard]] inline indexed_mesh random_prism(choices& c) {
    // A star around a centre: simple, not convex.
    std::size_t const n = 3 + c.below(9);
    std::vector<std::array<double, 2>> outline;
    for (std::size_t k = 0; k < n; ++k) {
        auto const p = circle_point(k, n);
        double const r = 0.25 + 0.75 * c.unit();
        outline.push_back({r * p[0], r * p[1]});
    }
    return prism(outline, 0, 0.1 + c.unit());
}

[[nodiscard]] inline indexed_mesh random_shape(choices& c, std::string& name) {
    switch (c.below(13)) {
        case 0: name = "box"; return unit_box();
        case 1: name = "flat box"; return box(vec3{0, 0, 0}, vec3{1, 1 + c.unit(), 0.001 + 0.1 * c.unit()});
        case 2: name = "L"; return l_shape();
        case 3: name = "cavity"; return box_with_cavity();
        case 4: name = "two boxes"; return two_boxes();
        case 5: name = "frame"; return frame();
        case 6: name = "tetrahedron"; return tetrahedron();
        case 7: name = "torus"; return torus(1, 0.2 + 0.6 * c.unit(), 3 + c.below(6), 3 + c.below(5));
        case 8: name = "sphere"; return icosphere(static_cast<int>(c.below(2)));
        case 9: name = "limbs"; return thin_limbs(0.02 + 0.2 * c.unit(), 1 + static_cast<int>(c.below(3)));
        case 10: name = "prism"; return random_prism(c);
        case 11: name = "needle"; return box(vec3{0, 0, 0}, vec3{1, 0.001, 0.001 + 0.1 * c.unit()});
        default: {
            name = "relief";
            std::uint64_t const seed = c.below(256);
            return height_block(2 + c.below(4), 2 + c.below(4), 0.25, [seed](std::size_t i, std::size_t j) {
                return 0.1 + lattice_noise(static_cast<double>(i) * 0.7, static_cast<double>(j) * 0.7, seed);
            });
        }
    }
}

/// Turned by angles with cosines like 3/5, whose products round: faces are no longer flat to the last bit.
inline void turn(indexed_mesh& m, choices& c) {
    for (int t = 0; t < 2; ++t) {
        auto const a = static_cast<Eigen::Index>(c.below(3));
        Eigen::Index const b = (a + 1) % 3;
        double const u = c.unit();
        double const s = 2 * u / (1 + u * u);
        double const k = (1 - u * u) / (1 + u * u);
        for (vec3& p : m.positions) {
            double const x = p[a];
            double const y = p[b];
            p[a] = k * x - s * y;
            p[b] = s * x + k * y;
        }
    }
}

[[nodiscard]] inline random_body make_random_body(choices& c) {
    random_body b;
    b.mesh = random_shape(c, b.name);
    if (c.chance(0.4)) {
        turn(b.mesh, c);
        b.name += " turned";
    }
    if (c.chance(0.3)) {
        double const scale = std::ldexp(c.between(1, 2), static_cast<int>(c.below(200)) - 100);
        for (vec3& p : b.mesh.positions) p *= scale;
        b.name += " scaled by " + std::to_string(scale);
    }
    if (c.chance(0.2)) {
        double size = 0;
        for (vec3 const& p : b.mesh.positions) size = std::max(size, tafoni::length(p));
        double const away = size * (c.chance(0.5) ? 1e9 : 1e3);
        for (vec3& p : b.mesh.positions) {
            for (int a = 0; a < 3; ++a) p[a] += away;
        }
        b.rounding = away / size * 0x1p-52;
        b.name += " moved";
        if (b.rounding > 1e-9) b.embedded = false;  // rounded to 1e-7: needles and limbs may cut themselves
    }
    return b;
}

/// Sites in the box of `s`, from spread out to degenerate; never twice the same place.
[[nodiscard]] inline std::vector<vec3> make_random_sites(tafoni::solid const& s, choices& c, std::string& name) {
    std::vector<vec3> sites;
    vec3 const lo = s.bounds.lo;
    vec3 const extent = s.bounds.extent();
    double const size = s.bounds.diagonal();
    auto const anywhere = [&] {
        vec3 p{0, 0, 0};
        for (int a = 0; a < 3; ++a) p[a] = lo[a] + extent[a] * c.unit();
        return p;
    };
    auto const lattice = [&](std::size_t n, double jitter) {
        for (std::size_t k = 0; k < n * n * n; ++k) {
            std::array<std::size_t, 3> const at{k % n, k / n % n, k / n / n};
            vec3 p{0, 0, 0};
            for (int a = 0; a < 3; ++a) {
                double const u = (static_cast<double>(at[static_cast<std::size_t>(a)]) + 0.5) / static_cast<double>(n);
                p[a] = lo[a] + extent[a] * u + (jitter > 0 ? jitter * size * (c.unit() - 0.5) : 0.0);
            }
            sites.push_back(p);
        }
    };
    std::size_t const n = 1 + c.below(24);
    switch (c.below(10)) {
        case 0:
            name = "uniform";
            for (std::size_t k = 0; k < n; ++k) sites.push_back(anywhere());
            break;
        case 1: name = "lattice"; lattice(1 + c.below(3), 0); break;
        case 2: {
            double const e = 10 + static_cast<double>(c.below(7));
            name = "lattice with jitter 1e-" + std::to_string(e);
            lattice(1 + c.below(3), std::pow(10.0, -e));
            break;
        }
        case 3: {
            name = "cluster";
            vec3 const at = anywhere();
            double const width = std::pow(10.0, -static_cast<double>(c.below(16)));
            for (std::size_t k = 0; k < n; ++k) {
                vec3 p = at;
                for (int a = 0; a < 3; ++a) p[a] += width * size * (c.unit() - 0.5);
                sites.push_back(p);
            }
            sites.push_back(anywhere());
            break;
        }
        case 4: {
            name = "coplanar";
            auto const a = static_cast<Eigen::Index>(c.below(3));
            double const at = lo[a] + extent[a] * c.unit();
            for (std::size_t k = 0; k < n; ++k) {
                sites.push_back(anywhere());
                sites.back()[a] = at;
            }
            break;
        }
        case 5: {
            name = "cospherical";
            vec3 const centre = s.bounds.centre();
            double const r = 0.4 * extent.minCoeff();
            for (std::size_t k = 0; k < n; ++k) {
                // Signed permutations of (r, r/2, r/4) all lie on one sphere, exactly about 0.
                std::array<double, 3> q{r, r / 2, r / 4};
                std::rotate(q.begin(), q.begin() + static_cast<std::ptrdiff_t>(c.below(3)), q.end());
                std::uint64_t const signs = c.below(8);
                vec3 p = centre;
                for (int a = 0; a < 3; ++a) p[a] += ((signs >> a) & 1) != 0 ? q[static_cast<std::size_t>(a)] : -q[static_cast<std::size_t>(a)];
                sites.push_back(p);
            }
            break;
        }
        case 6:
            name = "vertices of the solid";
            for (std::size_t k = 0; k < n; ++k) {
                auto const& t = s.triangles[c.below(s.triangles.size())];
                sites.push_back(s.positions[t[c.below(3)]]);
            }
            break;
        case 7:
            name = "on edges and faces of the solid";
            for (std::size_t k = 0; k < n; ++k) {
                auto const& t = s.triangles[c.below(s.triangles.size())];
                double const u = c.unit();
                double const v = c.chance(0.5) ? 0.0 : (1 - u) * c.unit();
                vec3 const p = s.positions[t[0]];
                sites.push_back(p + u * (s.positions[t[1]] - p) + v * (s.positions[t[2]] - p));
            }
            break;
        case 8: {
            name = "mirrored across the faces of the solid";
            for (std::size_t k = 0; k < n; ++k) {
                auto const& t = s.triangles[c.below(s.triangles.size())];
                vec3 const p = s.positions[t[0]];
                vec3 const normal = tafoni::cross(vec3(s.positions[t[1]] - p), vec3(s.positions[t[2]] - p));
                double const l = tafoni::length(normal);
                if (!(l > 0)) continue;
                vec3 const q = (p + s.positions[t[1]] + s.positions[t[2]]) / 3;
                vec3 const off = normal / l * (size * 0.05 * (1 + c.unit()));
                sites.push_back(q + off);
                sites.push_back(q - off);  // their bisector is the face
            }
            break;
        }
        default: {
            name = "collinear";
            vec3 const p = anywhere();
            vec3 const q = anywhere();
            for (std::size_t k = 0; k < n; ++k) sites.push_back(p + (q - p) * (static_cast<double>(k) / static_cast<double>(n)));
            break;
        }
    }
    for (vec3& p : sites) p = tafoni::detail::clamped(p, s.bounds);
    if (sites.empty()) sites.push_back(s.bounds.centre());
    return sites;
}

/// The laws of shards that hold for this body; points are few, so that many cases fit in a second.
[[nodiscard]] inline law_options laws_for(random_body const& b, tafoni::solid const& s, std::size_t points) {
    // Far from the origin the output is rounded, and thin bodies have much surface for their volume.
    double const thinness = s.area * s.bounds.diagonal() / s.volume;
    return {.embedded = b.embedded, .points = points, .tolerance = std::max(1e-9, b.rounding * thinness)};
}

}  // namespace tafoni_test

#endif
