/// \file
/// Where particles come from and where they are taken away.
#ifndef TAFONI_FLUID_EMITTER_HPP
#define TAFONI_FLUID_EMITTER_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/core/vector.hpp>

#include <limits>

namespace tafoni {

/// A box that particles start in, evenly spread, all with one velocity.
struct box_emitter {
    box3 box{};                ///< length unit; not empty
    vec3 velocity{0, 0, 0};    ///< length unit / s

    /// \throws invalid_input  `bad_box`, `bad_parameter`.
    void validate() const {
        for (int d = 0; d < 3; ++d) {
            if (!(box.lo[d] <= box.hi[d]) || !std::isfinite(box.lo[d]) || !std::isfinite(box.hi[d])) {
                detail::fail<invalid_input>(errc::bad_box, "box_emitter.box: is empty or not finite",
                                            {.kind = entity::parameter, .value = box.lo[d], .limit = box.hi[d]});
            }
            detail::require_range("box_emitter.velocity", velocity[d], -1e100, 1e100);
        }
    }
};

/// Particles outside this box are taken away.
struct box_sink {
    box3 keep{};  ///< length unit

    /// \throws invalid_input  `bad_box`.
    void validate() const { box_emitter{.box = keep}.validate(); }
};

}  // namespace tafoni

#endif
