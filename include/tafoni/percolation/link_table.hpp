/// \file
/// What the water meets at every link, packed so that one neighbour costs one cache line.
#ifndef TAFONI_PERCOLATION_LINK_TABLE_HPP
#define TAFONI_PERCOLATION_LINK_TABLE_HPP

#include <tafoni/core/sum.hpp>
#include <tafoni/graph/concepts.hpp>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace tafoni {

/// The changing and the often-read properties of one link. One cache line.
struct alignas(64) link_record {
    double x = 0;  ///< centroid
    double y = 0;
    double z = 0;
    double life = 0;        ///< lambda in [0, 1]; kept when a bond is laid open, so that it can be shown
    double resistance = 0;  ///< rho at the centroid, in [0, 1]
    double area = 0;        ///< squared length unit
    std::array<cell_index, 2> cells{};
    link_state state = link_state::gone;
    bool inward = false;    ///< the network's normal points into the rock
};

/// The link records of a network; refers to the network, which must outlive it.
template <link_network Network>
class link_table {
public:
    /// Copies centroids, normals, areas and cells; lives 1, resistances 0, states `gone`. O(links).
    /// \throws invalid_input  for an area or a centroid that is not finite, or an area <= 0.
    explicit link_table(Network const& network)
        : network_(&network), records_(network.link_count()), normals_(network.link_count(), vec3{0, 0, 0}) {
        for (std::size_t i = 0; i < records_.size(); ++i) {
            link_index const l{i};
            if (!network.has_link(l)) continue;
            link_record& r = records_[i];
            vec3 const c = network.link_centroid(l);
            r.x = c[0];
            r.y = c[1];
            r.z = c[2];
            r.area = network.link_area(l);
            r.cells = network.link_cells(l);
            normals_[i] = network.link_normal(l);
            if (!(r.area > 0 && r.area <= std::numeric_limits<double>::max()) || !is_finite(c)) {
                detail::fail<invalid_input>(errc::out_of_range,
                                            "link_table: link " + std::to_string(i) + " has area " +
                                                detail::number_text(r.area) + " or a centroid that is not finite",
                                            {.kind = entity::link, .index = i, .value = r.area});
            }
            r.life = r.cells[1].valid() ? 1.0 : 0.0;
        }
    }

    [[nodiscard]] Network const& network() const noexcept { return *network_; }
    [[nodiscard]] std::size_t size() const noexcept { return records_.size(); }
    [[nodiscard]] link_record& operator[](link_index l) noexcept { return records_[l.value]; }
    [[nodiscard]] link_record const& operator[](link_index l) const noexcept { return records_[l.value]; }

    /// The link as policies see it. Fields that the caller does not read cost nothing after inlining.
    [[nodiscard]] link_view view(link_index l) const {
        link_record const& r = records_[l.value];
        bool const bonded = r.state == link_state::bonded;
        vec3 const& n = normals_[l.value];
        double const sign = r.inward ? -1.0 : 1.0;
        return link_view{.id = l,
                         .cells = r.cells,
                         .centroid = vec3{r.x, r.y, r.z},
                         .normal = vec3{sign * n[0], sign * n[1], sign * n[2]},
                         .area = r.area,
                         .life = bonded ? r.life : 0.0,
                         .resistance = bonded ? r.resistance : 0.0,
                         .state = r.state};
    }

    /// Mean area of the interior links, or of all when `with_skin`; 1 when there is none. O(links).
    [[nodiscard]] double mean_area(bool with_skin) const {
        auto const counts = [&](std::size_t i) {
            return network_->has_link(link_index{i}) && (with_skin || records_[i].cells[1].valid());
        };
        std::size_t n = 0;
        for (std::size_t i = 0; i < records_.size(); ++i) n += counts(i) ? 1u : 0u;
        if (n == 0) return 1;
        return pairwise_sum(0, records_.size(), [&](std::size_t i) { return counts(i) ? records_[i].area : 0.0; }) /
               static_cast<double>(n);
    }

private:
    Network const* network_;
    std::vector<link_record> records_;
    std::vector<vec3> normals_;  ///< beside the records: most policies do not read them
};

}  // namespace tafoni

#endif
