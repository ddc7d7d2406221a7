/// \file
/// What a particle touches of a wall that is thinner than its reach: the side that it is on.
#ifndef TAFONI_FLUID_FACING_CONTACTS_HPP
#define TAFONI_FLUID_FACING_CONTACTS_HPP

#include <tafoni/core/vector.hpp>
#include <tafoni/fluid/concepts.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace tafoni {

namespace detail {

/// Faces that a particle stands in front of; the first of them where there are very many.
class sheltering_faces {
public:
    void add(boundary_contact const& c) noexcept {
        if (count_ == most) return;
        normal_[count_] = {c.normal[0], c.normal[1], c.normal[2]};
        distance_[count_++] = c.distance;
    }
    [[nodiscard]] bool empty() const noexcept { return count_ == 0; }
    /// Whether the foot of the normal of a face, which the particle is behind, lies behind one of them.
    [[nodiscard]] bool hide(boundary_contact const& c) const noexcept {
        for (std::size_t k = 0; k < count_; ++k) {
            auto const& n = normal_[k];
            if (distance_[k] - c.distance * (n[0] * c.normal[0] + n[1] * c.normal[1] + n[2] * c.normal[2]) < 0) return true;
        }
        return false;
    }

private:
    static constexpr std::size_t most = 32;
    std::array<std::array<double, 3>, most> normal_;
    std::array<double, most> distance_;
    std::size_t count_ = 0;
};

/// The contacts from number `first` on, but for what is hidden.
template <class Walls, class Visit>
void visit_unhidden(Walls const& walls, vec3 const& p, double radius, std::size_t first, Visit const& visit) {
    sheltering_faces front;
    double nearest = radius;
    walls.for_each_contact(p, radius, [&](boundary_contact const& c) {
        if (c.distance >= 0) front.add(c);
        nearest = std::min(nearest, std::fabs(c.distance));
    });
    // Over an edge of the near side no face of it has the foot, but the far side may. Nearer than that there is the edge.
    if (front.empty()) {
        walls.for_each_contact(p, nearest * (1 - 1e-9), [&](boundary_contact const& c) {
            if (c.distance < 0) return;
            front.add(c);
            visit(c);
        });
    }
    std::size_t number = 0;
    walls.for_each_contact(p, radius, [&](boundary_contact const& c) {
        if (number++ < first || (c.distance < 0 && front.hide(c))) return;
        visit(c);
    });
}

}  // namespace detail

/// Calls `visit` as `walls.for_each_contact` does, but not for a face that the particle is behind where the way there goes
/// through one that it is in front of: the far side of a thin wall neither pushes the particle, which would drag it through,
/// nor is it washed. Where an edge of the near side is nearest, that is visited instead. What has slipped through a face,
/// also in a corner, still meets it and is pushed back.
///
/// One question where the particle is behind no face, up to four where it is behind one. O(contacts).
template <fluid_boundary Walls, class Visit>
void for_each_facing_contact(Walls const& walls, vec3 const& p, double radius, Visit const& visit) {
    std::size_t visited = 0;
    bool behind = false;
    walls.for_each_contact(p, radius, [&](boundary_contact const& c) {
        behind = behind || c.distance < 0;
        if (behind) return;
        ++visited;
        visit(c);
    });
    if (behind) detail::visit_unhidden(walls, p, radius, visited, visit);
}

}  // namespace tafoni

#endif
