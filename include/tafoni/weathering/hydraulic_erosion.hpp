/// \file
/// Hydraulic erosion of a mesh by particles: the two forms of the process, as aggregates.
#ifndef TAFONI_WEATHERING_HYDRAULIC_EROSION_HPP
#define TAFONI_WEATHERING_HYDRAULIC_EROSION_HPP

#include <tafoni/core/elementary.hpp>
#include <tafoni/core/error.hpp>
#include <tafoni/curvature/concepts.hpp>
#include <tafoni/curvature/tensor_fit.hpp>
#include <tafoni/field/any_field.hpp>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>

namespace tafoni {

/// A particle on a face, as an exchange rule sees it.
struct wash_point {
    vec3 position{0, 0, 0};  ///< of the particle
    vec3 velocity{0, 0, 0};  ///< relative to the surface, length unit / s
    vec3 normal{0, 0, 0};    ///< of the face, unit, out of the solid
    double distance = 0;     ///< from the face, length unit; negative behind it
    double reach = 0;        ///< of the particle, length unit, > 0
};

/// How fast the surface goes down under a particle.
///
/// Laws: pure; finite; length unit / s; positive erodes, negative lays down (never more than the particle carries).
/// Model: `struct mine { double rate(wash_point const& at) const { return 1e-6 * length(at.velocity); } };`
template <class R>
concept exchange_rule = std::copy_constructible<R> && requires(R const& r, wash_point const& at) {
    { r.rate(at) } -> std::same_as<double>;
};

/// Erosion rate k (tau - tau_c)^a with the shear stress tau = K theta^m and the shear rate theta = v / d
/// [Partheniades 1965; Wojtan et al. 2007; Skorkovská's thesis, equations 8.2 to 8.4].
///
/// v is the velocity along the surface. d is the distance from the face, no less than a tenth of the particle's
/// reach, since particles are drawn as points but reach the face. Below tau_c the power keeps its sign, so the
/// rate is -k (tau_c - tau)^a and the particle lays down what it carries. Every parameter may be a field.
/// Models `exchange_rule`.
struct partheniades_erosion {
    any_field coefficient = 1e-6;  ///< k, length unit^3 / (N s) for stresses in Pa; >= 0
    any_field critical = 1;        ///< tau_c, Pa, >= 0
    any_field exponent = 1;        ///< a, > 0
    any_field consistency = 1;     ///< K, Pa s^m, >= 0
    any_field power = 1;           ///< m, > 0: 1 water, below 1 mud that thins, above 1 that thickens

    /// Length unit / s, positive where the surface goes down. O(1) and five fields, each asked at the particle.
    [[nodiscard]] double rate(wash_point const& at) const {
        vec3 const& n = at.normal;
        double const up = dot(at.velocity, n);
        vec3 const along{at.velocity[0] - up * n[0], at.velocity[1] - up * n[1], at.velocity[2] - up * n[2]};
        double const theta = length(along) / std::max(at.distance, 0.1 * at.reach);
        double const tau = consistency(at.position) * raised(theta, power(at.position));
        double const over = tau - critical(at.position);
        double const grown = raised(std::fabs(over), exponent(at.position));
        return coefficient(at.position) * (over < 0 ? -grown : grown);
    }

    /// Numbers only; fields are looked at where they are asked. \throws invalid_input  `bad_parameter`.
    void validate() const {
        check("coefficient", coefficient, 0, 1e100);
        check("critical", critical, 0, 1e100);
        check("exponent", exponent, 1e-6, 100);
        check("consistency", consistency, 0, 1e100);
        check("power", power, 1e-6, 100);
    }

private:
    [[nodiscard]] static double raised(double x, double e) noexcept {
        return e == 1 ? x : x > 0 ? elementary::pow(x, e) : 0.0;
    }
    static void check(char const* name, any_field const& f, double lo, double hi) {
        if (!f.is_constant()) return;
        detail::require_range((std::string("partheniades_erosion.") + name).c_str(), f(vec3{0, 0, 0}), lo, hi);
    }
};

static_assert(exchange_rule<partheniades_erosion>);

/// Erosion of every vertex near the water by its curvature, scaled into [0, 1], so that ridges go fastest and hollows
/// slowest [Skorkovská's thesis, section 9.4].
///
/// The range of curvature that is scaled is no less than a turn of the normals by 0.01 per mean edge, about its middle: what
/// lies below one ring cannot tell, so a plane and a ball wear evenly, by half of the most. Directions blend from
/// the inward normal where H is 0 to the Laplacian by |H| over the larger of |H_min| and |H_max| (at least half of that
/// turn), where the thesis reaches the Laplacian at H_min and at H_max each: on ridges over flat ground H_min is next to
/// 0, and the Laplacian of the flat ground rounding.
template <curvature_estimator Estimator = tensor_fit>
struct curvature_erosion {
    [[no_unique_address]] Estimator estimator{};
    double power = 1;      ///< n of equation 9.5, in [1, 100]
    double influence = 0;  ///< distance that a particle acts over, length unit; 0 = the mean edge (a flood: 3 of them)
    any_field durability = 1;  ///< divides the displacement; what is below 1e-3 counts as 1e-3

    /// \throws invalid_input  `bad_parameter`.
    void validate() const {
        detail::require_range("curvature_erosion.power", power, 1, 100);
        detail::require_range("curvature_erosion.influence", influence, 0, 1e100);
        if (durability.is_constant()) detail::require_range("curvature_erosion.durability", durability(vec3{0, 0, 0}), 0, 1e100);
    }
};

namespace detail {
template <class P>
inline constexpr bool is_curvature_erosion = false;
template <class E>
inline constexpr bool is_curvature_erosion<curvature_erosion<E>> = true;

/// The rule to ask about: `curvature_erosion` needs none.
template <class P>
struct rule_of {
    using type = P;
};
template <class E>
struct rule_of<curvature_erosion<E>> {
    using type = partheniades_erosion;
};
}  // namespace detail

/// What `hydraulic_run` runs: an exchange rule (chapter 8) or `curvature_erosion` (chapter 9).
template <class P>
concept hydraulic_process = exchange_rule<typename detail::rule_of<P>::type>;

/// How far vertices may go, and where the mesh gets finer.
struct hydraulic_options {
    double step_divisor = 10;       ///< no vertex moves farther in an iteration than the first mean edge over this, nor
                                    ///< than a quarter of the lowest triangle at it; >= 1
    double refine_length = 0;       ///< edges near water that are longer are split [thesis, 8.5], length unit; 0 = none
    std::uint32_t refine_every = 8; ///< iterations between two looks for long edges, >= 1
    std::uint32_t check_every = 0;  ///< vertices under water are given a way, less than half of that to the nearest triangle
                                    ///< that is no neighbour, so that walls do not cut each other; after so many iterations
                                    ///< new ones, where one in twenty has gone three quarters of it, and after ten times as
                                    ///< many anyway. 20 costs little, 1 lets what is fast go on best, 0 = never

    /// \throws invalid_input  `bad_parameter`.
    void validate() const {
        detail::require_range("hydraulic_options.step_divisor", step_divisor, 1, 1e100);
        detail::require_range("hydraulic_options.refine_length", refine_length, 0, 1e100);
        detail::require_range("hydraulic_options.refine_every", refine_every, 1, 4294967295.0);
    }
};

/// Rock in motion, cubed length unit, in the volumes that the mesh really changed by; exact:
/// eroded = deposited + carried + left to the last unit of the fixed point.
struct sediment_ledger {
    double eroded = 0;     ///< taken from the surface
    double deposited = 0;  ///< laid down on it
    double carried = 0;    ///< by particles, with what vertices still owe or are owed; below 0 only where more was laid
                           ///< down than the surface, whose vertices wait for each other, has given so far
    double left = 0;       ///< went away with particles, as far as the surface has given it, >= 0
};

/// Why a run ended.
enum class hydraulic_stop : std::uint8_t { finished, observer };

/// Totals since the start. Equal runs give equal reports.
struct hydraulic_report {
    std::uint64_t iterations = 0;
    double time = 0;                 ///< of the fluid, s
    std::size_t particles = 0;       ///< now
    std::uint64_t contacts = 0;      ///< of particles with faces, summed over iterations
    std::size_t vertices_added = 0;  ///< by refinement
    sediment_ledger ledger{};
    hydraulic_stop stopped = hydraulic_stop::finished;  ///< of the last `run`
};

}  // namespace tafoni

#endif
