/// \file
/// Joints as rocks have them: families of about parallel cracks.
#ifndef TAFONI_VOXEL_RANDOM_JOINTS_HPP
#define TAFONI_VOXEL_RANDOM_JOINTS_HPP

#include <tafoni/core/elementary.hpp>
#include <tafoni/core/error.hpp>
#include <tafoni/core/random.hpp>
#include <tafoni/core/vector.hpp>
#include <tafoni/voxel/joints.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace tafoni {

namespace stage {
inline constexpr std::uint32_t joints = 9;
}  // namespace stage

/// Discs of several orientations, strewn evenly [joints after Ito et al. 2003, as discs after Baecher et al. 1977].
struct random_joints {
    /// Joints that the same stress has opened.
    struct family {
        vec3 normal{0, 0, 1};    ///< mean, of any length > 0
        double spread = 5;       ///< degrees, in [0, 60]: normals lie within this of the mean
        double spacing = 1;      ///< length unit, > 0: mean way along the normal from joint to joint
        double radius_min = 1;   ///< length unit, > 0
        double radius_max = 1;   ///< length unit, >= radius_min; evenly drawn between
    };
    static constexpr std::size_t most = 1'000'000;  ///< discs

    std::vector<family> families{};

    /// \throws invalid_input  `bad_parameter`.
    void validate() const {
        for (std::size_t i = 0; i < families.size(); ++i) {
            family const& f = families[i];
            std::string const name = "random_joints.families[" + std::to_string(i) + "]";
            for (int a = 0; a < 3; ++a) detail::require_range((name + ".normal").c_str(), f.normal[a], -1e100, 1e100);
            detail::require_range((name + ".normal (length)").c_str(), length(f.normal), 1e-100, 1e101);
            detail::require_range((name + ".spread").c_str(), f.spread, 0, 60);
            detail::require_range((name + ".spacing").c_str(), f.spacing, 1e-100, 1e100);
            detail::require_range((name + ".radius_min").c_str(), f.radius_min, 1e-100, 1e100);
            detail::require_range((name + ".radius_max").c_str(), f.radius_max, f.radius_min, 1e100);
        }
    }

    /// The joints that reach into a box, so many that a line along a family's mean normal meets one every
    /// `spacing` where the spread is small. Each family and disc draws from a stream of its own. O(discs).
    /// \throws invalid_input  as `validate`; `empty_input` for an empty box, `size_overflow` for more than `most`
    /// discs.
    [[nodiscard]] joint_set operator()(box3 const& box, std::uint64_t seed) const {
        validate();
        if (box.empty() || !is_finite(box.lo) || !is_finite(box.hi)) {
            detail::fail<invalid_input>(errc::empty_input, "random_joints: got an empty box",
                                        {.kind = entity::parameter});
        }
        joint_set out;
        for (std::size_t i = 0; i < families.size(); ++i) strew(families[i], i, box, seed, out.discs);
        return out;
    }

private:
    static void strew(family const& f, std::size_t number, box3 const& box, std::uint64_t seed,
                      std::vector<joint_disc>& out) {
        constexpr double pi = 3.141592653589793;
        // Centres lie around the box too: a joint that reaches in from there is as likely as one within.
        vec3 const reach{f.radius_max, f.radius_max, f.radius_max};
        vec3 const lo = box.lo - reach;
        vec3 const size = box.hi + reach - lo;
        double const a = f.radius_min;
        double const b = f.radius_max;
        double const mean_area = pi * (a * a + a * b + b * b) / 3;
        double const count = std::floor(size[0] / f.spacing * (size[1] * (size[2] / mean_area)) + 0.5);
        if (!(count <= static_cast<double>(most - out.size()))) {
            detail::fail<invalid_input>(
                errc::size_overflow,
                "random_joints.families[" + std::to_string(number) + "]: got " + detail::number_text(count) +
                    " discs, at most " + std::to_string(most) + " in all",
                {.kind = entity::parameter, .index = number, .value = count, .limit = static_cast<double>(most)});
        }
        vec3 const n = normalized(f.normal);
        vec3 const side = normalized(std::fabs(n[2]) < 0.6 ? cross(n, vec3{0, 0, 1}) : cross(n, vec3{1, 0, 0}));
        vec3 const other = cross(n, side);
        double const angle = f.spread * (pi / 180);
        double const lean = sin(angle) / cos(angle);
        for (std::uint64_t d = 0; d < static_cast<std::uint64_t>(count); ++d) {
            stream draw(seed, stage::joints, static_cast<std::uint64_t>(number) << 32 | d);
            double const x = draw.uniform01();
            double const y = draw.uniform01();
            double const z = draw.uniform01();
            double const radius = draw.uniform(f.radius_min, f.radius_max);
            double u = 0;
            double v = 0;
            do {
                u = draw.uniform(-1, 1);
                v = draw.uniform(-1, 1);
            } while (u * u + v * v > 1);
            joint_disc disc{.centre = {lo[0] + size[0] * x, lo[1] + size[1] * y, lo[2] + size[2] * z},
                            .radius = radius};
            for (int k = 0; k < 3; ++k) disc.normal[k] = n[k] + lean * (u * side[k] + v * other[k]);
            if (touches(disc, box)) out.push_back(disc);
        }
    }
    /// Whether the disc's ball reaches the box.
    static bool touches(joint_disc const& d, box3 const& box) {
        double away = 0;
        for (int k = 0; k < 3; ++k) {
            double const gap = std::max({box.lo[k] - d.centre[k], d.centre[k] - box.hi[k], 0.0});
            away += gap * gap;
        }
        return away <= d.radius * d.radius;
    }
};

}  // namespace tafoni

#endif
