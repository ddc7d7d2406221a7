/// \file
/// Weathering driven by mean curvature on triangles: which policies make up the process.
#ifndef TAFONI_WEATHERING_CURVATURE_WEATHERING_HPP
#define TAFONI_WEATHERING_CURVATURE_WEATHERING_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/curvature/concepts.hpp>
#include <tafoni/curvature/displacement.hpp>
#include <tafoni/curvature/tensor_fit.hpp>
#include <tafoni/field/concepts.hpp>
#include <tafoni/field/constant.hpp>
#include <tafoni/rules/parameter_checks.hpp>
#include <tafoni/rules/roles.hpp>
#include <tafoni/weathering/detail/durability_role.hpp>

#include <cstdint>
#include <span>

namespace tafoni {

namespace detail {
struct estimator_role {
    struct refused : refused_part {
        using refused_part::refused_part;
        void operator()(surface_view const&, std::span<double>, auto const&) const;
    };
    template <class T>
    static constexpr bool fits = curvature_estimator<T>;
    template <class T>
    static constexpr bool resembles = false;
    template <class T>
    static void expect() {
        static_assert(fits<T>, "`estimator` takes a curvature_estimator: tafoni::tensor_fit{}, quadric_fit{}, your own");
    }
};
struct direction_role {
    template <class T>
    static constexpr bool fits = direction_policy<T>;
    template <class T>
    static constexpr bool resembles = requires { &T::direction; };
    template <class T>
    static void expect() {
        static_assert(fits<T>, "`direction` takes a direction_policy: vec3 direction(wear_point const&) const");
    }
};
using curvature_members = bundle_members<bundle_member<estimator_role, tensor_fit>,
                                         bundle_member<direction_role, laplacian_direction>,
                                         bundle_member<durability_role, constant_field>>;
}  // namespace detail

/// Salt, frost and wind that wear what sticks out [Skorkovská's thesis, section 9.3].
///
/// Every iteration moves the vertices of positive mean curvature by H^n e / (x durability) along `direction`, H
/// scaled into [-1, 1] and e the mean edge. Durability is asked at the vertex; what is below `least_durability`
/// counts as that. Run it with `curvature_run`.
template <curvature_estimator Estimator = tensor_fit, direction_policy Direction = laplacian_direction,
          scalar_field Durability = constant_field>
struct curvature_weathering {
    using members = detail::curvature_members;  ///< for deduction

    static constexpr double least_durability = 1e-3;

    [[no_unique_address]] Estimator estimator{};
    [[no_unique_address]] Direction direction{};
    [[no_unique_address]] Durability durability = detail::even_durability<Durability>();  ///< divides the displacement

    template <class F>
    void for_each_policy(F const& f) const {
        f(estimator);
        f(direction);
        f(durability);
    }
    /// \throws invalid_input  `bad_parameter` when a policy's own `validate()` says so.
    void validate() const { detail::validate_policies(*this); }
};

template <class... Parts>
    requires(!detail::bundle_of<detail::curvature_members, Parts> && ...)
curvature_weathering(Parts...) -> curvature_weathering<detail::pick_part_t<detail::curvature_members, 0, Parts...>,
                                                       detail::pick_part_t<detail::curvature_members, 1, Parts...>,
                                                       detail::pick_part_t<detail::curvature_members, 2, Parts...>>;

/// What happens to the triangles while vertices move.
enum class mesh_topology {
    adapt,  ///< edges shorter than `small_edge` mean edges, and their triangles, are removed after every iteration
    keep    ///< vertices and triangles keep their numbers, for hosts that need it
};

/// How far vertices go, what happens to small triangles and to those that cut each other.
struct curvature_options {
    double power = 1;            ///< n of equation 9.5, in [1, 100]; larger spares flat regions
    double step_divisor = 10;    ///< x of equation 9.3: no vertex moves farther than a mean edge / x; >= 1
    double small_edge = 0.1;     ///< edges below this share of the mean edge are removed, in [0, 0.5]
    mesh_topology topology = mesh_topology::adapt;
    /// Iterations between searches for triangles that cut each other, and once more at the end of every run; 0 = never.
    std::uint32_t check_every = 0;
    /// How often a surface may be taken back to the last sound one where the search finds some, with half the step or
    /// with more held still, 0 to 60.
    std::uint32_t retries = 6;
    /// Halvings of the step after which the vertices of the triangles that still cut each other are held still, with those
    /// within an edge of them (two edges the second time in a row, ...), and the step grows back. `retries` or more: never.
    std::uint32_t hold_after = 2;

    /// \throws invalid_input  `bad_parameter`.
    void validate() const {
        detail::require_range("curvature_options.power", power, 1, 100);
        detail::require_range("curvature_options.step_divisor", step_divisor, 1, 1e100);
        detail::require_range("curvature_options.small_edge", small_edge, 0, 0.5);
        detail::require_range("curvature_options.retries", retries, 0, 60);
        if (topology != mesh_topology::adapt && topology != mesh_topology::keep) {
            detail::fail<invalid_input>(errc::bad_parameter, "curvature_options.topology: adapt or keep",
                                        {.kind = entity::parameter});
        }
    }
};

}  // namespace tafoni

#endif
