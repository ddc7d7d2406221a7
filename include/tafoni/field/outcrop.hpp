/// \file
/// A rock that needs no file: a tor of bedded, jointed rock with ledges and an overhanging front.
#ifndef TAFONI_FIELD_OUTCROP_HPP
#define TAFONI_FIELD_OUTCROP_HPP

#include <tafoni/core/elementary.hpp>
#include <tafoni/core/random.hpp>
#include <tafoni/field/fractal_noise.hpp>
#include <tafoni/geometry/indexed_mesh.hpp>

#include <algorithm>
#include <array>
#include <vector>

namespace tafoni {

namespace detail {

/// A joint plane, upright: the points p with n . p = distance, n horizontal and of unit length.
struct outcrop_joint {
    vec3 normal{1, 0, 0};
    double distance = 1;
};

/// By the angle from +x, 0 to one turn, without computing it; horizontal directions.
[[nodiscard]] inline bool earlier_around(vec3 const& a, vec3 const& b) noexcept {
    auto const half = [](vec3 const& p) { return p[1] > 0 || (p[1] == 0 && p[0] > 0) ? 0 : 1; };
    if (half(a) != half(b)) return half(a) < half(b);
    return a[0] * b[1] - a[1] * b[0] > 0;
}

/// An upright cleft; the rock behind it, anticlockwise up to the next one, stands out or back.
struct outcrop_cleft {
    static constexpr double half_width = 0.014;  // radians around the axis
    vec3 out{1, 0, 0};
    double step = 0;  ///< m
};

/// A bed: the union of blocks, each the convex piece within its joints, all around the axis x = y = 0.
struct outcrop_bed {
    static constexpr std::size_t sides = 5;
    std::array<std::array<outcrop_joint, sides>, 3> blocks{};
    std::vector<outcrop_cleft> clefts{};  ///< in order around the axis, at least one
    double bottom = 0;  ///< m
    double top = 0;     ///< m
    double batter = 0;  ///< relative growth of the outline per metre of height

    /// Distance from the axis to the outline with its clefts, seen along the horizontal unit vector `out`.
    [[nodiscard]] double reach(vec3 const& out) const noexcept {
        double step = clefts.back().step;
        for (outcrop_cleft const& c : clefts) {
            if (squared_length(vec3{out - c.out}) < 0.25 * c.half_width * c.half_width) return joints(out) + step - 0.14;
            if (earlier_around(c.out, out)) step = c.step;
        }
        return joints(out) + step;
    }

    /// The same without the clefts.
    [[nodiscard]] double joints(vec3 const& out) const noexcept {
        double r = 0;
        for (auto const& block : blocks) {
            double least = 1e300;
            for (outcrop_joint const& j : block) {
                double const c = dot(j.normal, out);
                if (c > 1e-9) least = std::min(least, j.distance / c);
            }
            r = std::max(r, least);
        }
        return r;
    }
};

/// What the outcrop of a seed is built from.
class outcrop_plan {
public:
    static constexpr double height = 4.6;  // m

    explicit outcrop_plan(std::uint64_t seed) : seed_(seed) {
        stream random(seed, stage::user, 0);
        double const strike = random.uniform(-0.35, -0.15);
        std::array<std::array<double, outcrop_bed::sides>, 3> share{};
        for (auto& block : share) {
            for (double& s : block) s = random.uniform(0.58, 0.95);
        }
        // Every side is reached by one block at least.
        for (std::size_t side = 0; side < outcrop_bed::sides; ++side) share[side % 3][side] = 1;
        double z = 0;
        for (std::size_t k = 0; z < height; ++k) {
            outcrop_bed bed;
            bed.bottom = z;
            // Thick beds with thin ones between them, which stand back.
            bool const soft = k % 3 == 1;
            z += soft ? random.uniform(0.2, 0.34) : random.uniform(k == 0 ? 0.75 : 0.42, 1.1);  // above 0.7 the tilt is even, see bent()
            if (z > height - 0.3) z = height;
            bed.top = z;
            double const crown = z < height ? 1 : 0.72;
            bed.batter = random.uniform(-0.08, 0.05);
            double const turn = strike + random.uniform(-0.06, 0.06);
            for (std::size_t b = 0; b < 3; ++b) {
                for (std::size_t side = 0; side < outcrop_bed::sides; ++side) {
                    double const far = crown * share[b][side] * random.uniform(0.88, 1.08) - (soft ? 0.1 : 0);
                    bed.blocks[b][side] = joint(side, b, (bed.bottom + bed.top) / (2 * height), turn, far);
                }
            }
            for (std::size_t c = soft ? 2 : 7; c > 0; --c) {
                double const angle = random.uniform(-3.141592653589793, 3.141592653589793);
                double const step = random.uniform(-0.2, 0.05);
                bed.clefts.push_back({vec3{elementary::cos(angle), elementary::sin(angle), 0}, step});
            }
            std::sort(bed.clefts.begin(), bed.clefts.end(), [](outcrop_cleft const& a, outcrop_cleft const& b) {
                return earlier_around(a.out, b.out);
            });
            beds_.push_back(std::move(bed));
        }
    }

    [[nodiscard]] std::vector<outcrop_bed> const& beds() const noexcept { return beds_; }

    /// Unit directions around the axis, anticlockwise: about `around` even ones and the corners of the outlines.
    [[nodiscard]] std::vector<vec3> directions(std::size_t around) const {
        double const step = 6.283185307179586 / static_cast<double>(around);
        std::vector<vec3> corners;
        for (outcrop_bed const& bed : beds_) add_corners(bed, corners);
        std::sort(corners.begin(), corners.end(), earlier_around);
        std::vector<vec3> all;
        auto const apart = [&](vec3 const& p, double least) {
            return all.empty() || (squared_length(vec3{p - all.back()}) > least * least &&
                                   squared_length(vec3{p - all.front()}) > least * least);
        };
        for (vec3 const& p : corners) {
            if (apart(p, 0.3 * step)) all.push_back(p);
        }
        std::vector<vec3> const kept = all;
        for (std::size_t i = 0; i < around; ++i) {
            double const angle = step * static_cast<double>(i);
            vec3 const p{elementary::cos(angle), elementary::sin(angle), 0};
            bool const free = std::none_of(kept.begin(), kept.end(), [&](vec3 const& q) {
                return squared_length(vec3{p - q}) < 0.36 * step * step;
            });
            if (free) all.push_back(p);
        }
        std::sort(all.begin(), all.end(), earlier_around);
        return all;
    }

    /// What the flank stands out at a point of it, m; small against every radius.
    [[nodiscard]] double roughness(vec3 const& p) const noexcept {
        return 0.09 * fractal_noise{.seed = seed_, .frequency = 2, .octaves = 3}(p);
    }

    /// Tilts and warps the beds: moves along z only, by what depends on x and y, fading out to z = 0.
    /// `warp`: height of the waves, m; they are long, so faces much shorter than a metre follow them.
    [[nodiscard]] vec3 bent(vec3 const& p, double warp) const noexcept {
        double const wave = gradient_noise{.seed = seed_ + 1, .frequency = 0.4}(vec3{p[0], p[1], 0});
        double const lift = std::min(1.0, p[2] / 0.7);
        return {p[0], p[1], p[2] + lift * (0.13 * p[0] - 0.05 * p[1] + warp * wave)};
    }

private:
    /// Side 0 .. 3 looks to +x, +y, -x, -y; side 4 cuts off a corner. `t`: height, 0 .. 1.
    [[nodiscard]] static outcrop_joint joint(std::size_t side, std::size_t block, double t, double turn, double far) {
        auto const ease = [](double x) {
            x = std::clamp(x, 0.0, 1.0);
            return x * x * (3 - 2 * x);
        };
        constexpr double quarter = 1.5707963267948966;
        double angle = turn + quarter * static_cast<double>(side);
        double reach = 1;
        if (side == 0) reach = 2.9 - 0.5 * ease(3 * t) - 1.0 * ease(2.5 * t - 1.2);
        if (side == 1) reach = 2.6 - 0.8 * t;
        if (side == 2) reach = 3.0 - 0.7 * ease(2.5 * t - 1.4);
        // The front: a foot, a niche over it, a nose over the niche, the top set back.
        if (side == 3) reach = 2.3 - 0.9 * ease((t - 0.08) / 0.2) + 0.85 * ease((t - 0.42) / 0.2) - 0.6 * ease((t - 0.75) / 0.2);
        if (side == 4) {
            angle = turn + quarter * (0.45 + 1.1 * static_cast<double>(block) + 0.2 * far);
            reach = 2.9 - 0.5 * t;
        }
        return {vec3{elementary::cos(angle), elementary::sin(angle), 0}, reach * far};
    }

    static void add_corners(outcrop_bed const& bed, std::vector<vec3>& corners) {
        for (outcrop_cleft const& c : bed.clefts) {
            for (double const w : {-c.half_width, 0.0, c.half_width}) {
                corners.push_back(normalized(vec3{c.out[0] - w * c.out[1], c.out[1] + w * c.out[0], 0}));
            }
        }
        std::vector<outcrop_joint> lines;
        for (auto const& block : bed.blocks) lines.insert(lines.end(), block.begin(), block.end());
        for (std::size_t i = 0; i < lines.size(); ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                vec3 const& a = lines[i].normal;
                vec3 const& b = lines[j].normal;
                double const det = a[0] * b[1] - a[1] * b[0];
                if (std::fabs(det) < 0.05) continue;
                double const x = (lines[i].distance * b[1] - lines[j].distance * a[1]) / det;
                double const y = (lines[j].distance * a[0] - lines[i].distance * b[0]) / det;
                double const r = std::sqrt(x * x + y * y);
                if (!(r > 0.1)) continue;
                vec3 const out{x / r, y / r, 0};
                if (std::fabs(bed.joints(out) - r) < 1e-6) corners.push_back(out);
            }
        }
    }

    std::uint64_t seed_;
    std::vector<outcrop_bed> beds_{};
};

}  // namespace detail

/// A procedural tor about 6 m wide, 5 m deep and 4.6 m high, standing on z = 0, z up: tilted beds of
/// uneven thickness, cut by upright joints and clefts, with a niche and an overhang in front (-y).
///
/// Closed, outward oriented, embedded: before the beds are tilted, every half-plane at the axis meets the flank
/// in a graph over the height. Quads and two fans of triangles. The beds' normal is that of (-0.13, 0.05, 1).
/// `resolution` in 4 .. 2000 is about the number of rows up the flank; there are 6 to 13 resolution^2 faces from 40 on.
/// Depends on the arguments only. O(faces).
/// \throws invalid_input  `bad_parameter`.
[[nodiscard]] inline indexed_mesh make_outcrop(std::uint64_t seed = 1, std::size_t resolution = 40) {
    detail::require_range("make_outcrop.resolution", static_cast<double>(resolution), 4, 2000);
    detail::outcrop_plan const plan(seed);
    double const height = detail::outcrop_plan::height;
    // Coarse faces would cut each other where they cannot follow the waves.
    double const warp = 0.15 * std::min(1.0, static_cast<double>(resolution * resolution) / 1600);
    std::vector<vec3> const directions = plan.directions(4 * resolution);
    std::size_t const around = directions.size();
    std::size_t const across = resolution / 20 + 1;
    std::vector<double> rim(around, 0);  // of the ring before
    indexed_mesh mesh;
    std::size_t rings = 0;
    auto const ring = [&](double z, auto const& reach) {
        for (std::size_t i = 0; i < around; ++i) {
            double const r = reach(i);
            mesh.add_vertex(plan.bent(vec3{r * directions[i][0], r * directions[i][1], z}, warp));
        }
        ++rings;
    };
    double const seam = 0.06;   // m: height over which a ledge rises
    double const bevel = 0.04;  // m
    for (detail::outcrop_bed const& bed : plan.beds()) {
        std::vector<double> reach(around);
        for (std::size_t i = 0; i < around; ++i) reach[i] = bed.reach(directions[i]);
        auto const at = [&](double z, double inset) {
            double const grown = 1 + bed.batter * (z - bed.bottom);
            return [&, z, grown, inset](std::size_t i) {
                double const r = std::max(reach[i] * grown - inset, 0.4);
                return r + plan.roughness(vec3{r * directions[i][0], r * directions[i][1], z});
            };
        };
        double low = bed.bottom;
        if (rings > 0) {
            auto const foot = at(low + seam, 0.5 * bevel);
            for (std::size_t k = 1; k <= across; ++k) {
                double const t = static_cast<double>(k) / static_cast<double>(across + 1);
                ring(low + t * seam, [&](std::size_t i) { return (1 - t) * rim[i] + t * foot(i); });
            }
            low += seam;
            ring(low, foot);
            low += bevel;
        }
        double const high = bed.top - bevel;
        auto const rows = static_cast<std::size_t>(std::floor(static_cast<double>(resolution) * (high - low) / height)) + 1;
        for (std::size_t k = 0; k <= rows; ++k) {
            double const z = low + (high - low) * static_cast<double>(k) / static_cast<double>(rows);
            ring(z, at(z, 0));
        }
        auto const last = at(bed.top, bevel);
        ring(bed.top, last);
        for (std::size_t i = 0; i < around; ++i) rim[i] = last(i);
    }
    std::size_t const over = resolution / 4 + 1;
    for (std::size_t k = 1; k < over; ++k) {
        double const u = 1 - static_cast<double>(k) / static_cast<double>(over);
        ring(height, [&](std::size_t i) { return u * rim[i]; });
    }
    auto const at = [&](std::size_t row, std::size_t i) { return static_cast<std::uint32_t>(row * around + i % around); };
    auto const bottom = mesh.add_vertex(plan.bent(vec3{0, 0, 0}, warp)).value;
    auto const summit = mesh.add_vertex(plan.bent(vec3{0, 0, height}, warp)).value;
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
