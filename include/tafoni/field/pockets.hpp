/// \file
/// Bodies of another rock inside a rock.
#ifndef TAFONI_FIELD_POCKETS_HPP
#define TAFONI_FIELD_POCKETS_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/field/constant.hpp>

#include <vector>

namespace tafoni {

/// An ellipsoid with axes along x, y and z.
struct pocket {
    vec3 centre{0, 0, 0};
    vec3 radii{1, 1, 1};  ///< > 0, length unit; equal for a ball
    double value = 0;     ///< inside

    [[nodiscard]] bool contains(vec3 const& p) const noexcept {
        double const x = (p[0] - centre[0]) / radii[0];
        double const y = (p[1] - centre[1]) / radii[1];
        double const z = (p[2] - centre[2]) / radii[2];
        return x * x + y * y + z * z <= 1;
    }
};

/// The value of the last pocket that contains the point, else that of `base`. Models `scalar_field`.
template <scalar_field Base = constant_field>
struct pockets {
    [[no_unique_address]] Base base{};
    std::vector<pocket> bodies{};

    /// O(bodies).
    [[nodiscard]] double operator()(vec3 const& p) const {
        for (auto b = bodies.rbegin(); b != bodies.rend(); ++b) {
            if (b->contains(p)) return b->value;
        }
        return base(p);
    }

    /// \throws invalid_input  if a radius is not positive or a number not finite.
    void validate() const {
        for (pocket const& b : bodies) {
            for (int a = 0; a < 3; ++a) {
                detail::require_range("pocket.centre", b.centre[a], -1e300, 1e300);
                detail::require_range("pocket.radii", b.radii[a], 1e-300, 1e300);
            }
            detail::require_range("pocket.value", b.value, -1e300, 1e300);
        }
        if constexpr (requires { base.validate(); }) base.validate();
    }
};

template <class Base>
pockets(Base, std::vector<pocket>) -> pockets<Base>;

static_assert(scalar_field<pockets<>>);

}  // namespace tafoni

#endif
