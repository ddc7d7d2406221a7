/// \file
/// Which pieces that are cut off rest on others nevertheless.
#ifndef TAFONI_VOXEL_DETAIL_ROCKFALL_FRICTION_HPP
#define TAFONI_VOXEL_DETAIL_ROCKFALL_FRICTION_HPP

#include <tafoni/core/elementary.hpp>
#include <tafoni/voxel/detail/rockfall_search.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

namespace tafoni::detail {

/// Adds to `loose`, whole groups, those that they rest on, and takes out what stands: a group that lies no steeper
/// than the angle on something that stands. What is held stands; among the rest it takes something that stands without
/// them, so pieces that only rest on one another fall.
class rockfall_friction {
public:
    explicit rockfall_friction(double degrees) noexcept
        : sine_(sin(degrees * 0.017453292519943295)), cosine_(cos(degrees * 0.017453292519943295)) {}

    /// O(bricks of the groups + contacts).
    void keep_standing(sparse_grid const& grid, rockfall_search& search, std::vector<std::uint32_t>& loose) const {
        std::vector<rest> rests;
        std::map<std::uint32_t, std::size_t> place;
        for (std::uint32_t const g : loose) place.emplace(g, place.size());
        for (std::size_t i = 0; i < loose.size(); ++i) {
            rests.push_back(look_under(grid, search, loose[i]));
            for (std::uint32_t& under : rests.back().on) {
                under = search.root(under);
                if (search.at(under).is == rockfall_search::state::held) continue;
                if (place.emplace(under, loose.size()).second) loose.push_back(under);
            }
        }
        std::vector<std::vector<std::size_t>> carries(loose.size());
        std::vector<bool> stands(loose.size());
        std::vector<std::size_t> due;
        for (std::size_t i = 0; i < loose.size(); ++i) {
            if (!rests[i].flat) continue;
            for (std::uint32_t const under : rests[i].on) {
                if (search.at(under).is != rockfall_search::state::held) {
                    carries[place.at(under)].push_back(i);
                } else if (!stands[i]) {
                    stands[i] = true;
                    due.push_back(i);
                }
            }
        }
        while (!due.empty()) {
            std::size_t const i = due.back();
            due.pop_back();
            for (std::size_t const j : carries[i]) {
                if (stands[j]) continue;
                stands[j] = true;
                due.push_back(j);
            }
        }
        std::size_t kept = 0;
        for (std::size_t i = 0; i < loose.size(); ++i) {
            if (!stands[i]) loose[kept++] = loose[i];
        }
        loose.resize(kept);
    }

private:
    struct rest {
        bool flat = false;
        std::vector<std::uint32_t> on{};  ///< groups
    };

    rest look_under(sparse_grid const& grid, rockfall_search& search, std::uint32_t g) const {
        rest out;
        std::map<std::uint32_t, std::uint64_t> faces;  // of each joint; counted, so that no order matters
        std::vector<rock_node> under;
        for (rock_node const n : search.at(g).nodes) {
            search.for_contacts(grid, n, [&](voxel v) {
                voxel const low{v.x, v.y, v.z - 1};
                rock_node const m = search.node_of(grid, low);
                std::uint32_t const in = search.group_if_seen(grid, m);
                if (in == g) return;  // a crack that ends within the piece
                ++faces[search.cuts().plane_under(grid, low)];
                if (under.empty() || under.back() != m) under.push_back(m);
            });
        }
        if (under.empty()) return out;
        std::sort(under.begin(), under.end());
        under.erase(std::unique(under.begin(), under.end()), under.end());
        for (rock_node const m : under) out.on.push_back(search.settle(grid, search.group_of(grid, m)));
        std::sort(out.on.begin(), out.on.end());
        out.on.erase(std::unique(out.on.begin(), out.on.end()), out.on.end());
        out.flat = is_flat(grid, search, faces);
        return out;
    }

    /// A face of a contact stands for 1 / n_up of its joint's area, so the sum of the normals by area is
    /// the sum of n / n_up.
    bool is_flat(sparse_grid const& grid, rockfall_search const& search,
                 std::map<std::uint32_t, std::uint64_t> const& faces) const {
        auto const& axis = grid.rotation().axis;
        double lean_x = 0;
        double lean_y = 0;
        double total = 0;
        for (auto const& [plane, count] : faces) {
            vec3 const& n = search.cuts().planes()[plane].normal;
            double up = n[static_cast<Eigen::Index>(axis[2])];
            double const sign = up < 0 ? -1 : 1;
            up = std::max(std::fabs(up), 1e-6);
            auto const weight = static_cast<double>(count);
            lean_x += weight * sign * n[static_cast<Eigen::Index>(axis[0])] / up;
            lean_y += weight * sign * n[static_cast<Eigen::Index>(axis[1])] / up;
            total += weight;
        }
        return std::sqrt(lean_x * lean_x + lean_y * lean_y) * cosine_ <= total * sine_ * (1 + 1e-9);
    }

    double sine_;
    double cosine_;
};

}  // namespace tafoni::detail

#endif
