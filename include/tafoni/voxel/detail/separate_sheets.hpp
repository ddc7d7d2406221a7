/// \file
/// Gives every piece of a surface that is a difference of two its own vertices.
#ifndef TAFONI_VOXEL_DETAIL_SEPARATE_SHEETS_HPP
#define TAFONI_VOXEL_DETAIL_SEPARATE_SHEETS_HPP

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tafoni::detail {

/// What is left of an outer closed 2-manifold and of an inner one, turned inside out, when the triangles that they
/// share have cancelled. Where the two still touch along an edge, four triangles meet there: the solid between
/// them is pinched, so outer and inner sheet of the same side are paired. Where two vertices touch
/// along nothing but the edge between them, that would leave both sides with the same two vertices; there each sheet
/// goes on as it was.
class separate_sheets {
public:
    /// `corners`: three vertices per triangle; `inner`: per triangle; `common`: per vertex, whether both surfaces
    /// may have it. Afterwards corners name new vertices from `vertices` on where pieces touched; returns
    /// of each new vertex which one it doubles. O(n log n) for n corners at common vertices.
    std::vector<std::uint32_t> operator()(std::span<std::uint32_t> corners, std::span<std::uint8_t const> inner,
                                          std::span<std::uint8_t const> common, std::uint32_t vertices) {
        collect(corners, inner, common);
        std::vector<std::uint32_t> doubled;
        std::vector<std::uint8_t> done;
        for (std::size_t g = 0; g + 1 < groups_.size(); ++g) {
            std::span<fan_corner const> const fan(fans_.data() + groups_[g], groups_[g + 1] - groups_[g]);
            bool const apart = lonely_[g] != nobody && partner(lonely_[g]) == fan.front().at;
            done.assign(fan.size(), 0);
            bool first = true;
            for (std::size_t start = 0; start < fan.size(); ++start) {
                if (done[start] != 0) continue;
                std::uint32_t name = fan.front().at;
                if (!first) {
                    name = vertices + static_cast<std::uint32_t>(doubled.size());
                    doubled.push_back(fan.front().at);
                }
                first = false;
                for (std::size_t k = start; done[k] == 0; k = following(fan, k, apart)) {
                    done[k] = 1;
                    corners[fan[k].corner] = name;
                }
            }
        }
        return doubled;
    }

private:
    static constexpr std::uint32_t nobody = 0xFFFFFFFFU;

    struct fan_corner {
        std::uint32_t at;
        std::uint32_t corner;
        std::uint32_t next;
        std::uint32_t previous;
        std::uint8_t inner;
    };

    void collect(std::span<std::uint32_t const> corners, std::span<std::uint8_t const> inner,
                 std::span<std::uint8_t const> common) {
        fans_.clear();
        for (std::uint32_t c = 0; c < corners.size(); ++c) {
            if (common[corners[c]] == 0) continue;
            std::uint32_t const t = c - c % 3;
            fans_.push_back({corners[c], c, corners[t + (c + 1) % 3], corners[t + (c + 2) % 3], inner[t / 3]});
        }
        std::sort(fans_.begin(), fans_.end(), [](fan_corner const& a, fan_corner const& b) {
            return a.at != b.at ? a.at < b.at : a.corner < b.corner;
        });
        groups_.clear();
        for (std::size_t k = 0; k < fans_.size(); ++k) {
            if (k == 0 || fans_[k].at != fans_[k - 1].at) groups_.push_back(k);
        }
        groups_.push_back(fans_.size());
        lonely_.clear();
        for (std::size_t g = 0; g + 1 < groups_.size(); ++g) {
            lonely_.push_back(only_touch({fans_.data() + groups_[g], groups_[g + 1] - groups_[g]}));
        }
    }

    /// The one vertex to which an edge of both surfaces leads, when all four of its triangles are left.
    static std::uint32_t only_touch(std::span<fan_corner const> fan) {
        std::uint32_t found = nobody;
        for (fan_corner const& a : fan) {
            if (a.inner != 0) continue;
            for (fan_corner const& b : fan) {
                if (b.inner == 0) continue;
                if (b.previous == a.next || b.next == a.previous) {
                    std::uint32_t const to = b.previous == a.next ? a.next : a.previous;
                    if (found != nobody && found != to) return nobody;
                    found = to;
                    if (b.previous == a.next && b.next == a.previous) return nobody;
                }
            }
        }
        if (found == nobody) return nobody;
        std::size_t meeting = 0;
        for (fan_corner const& a : fan) meeting += a.next == found ? 1U : 0U;
        return meeting == 2 ? found : nobody;
    }

    [[nodiscard]] std::uint32_t partner(std::uint32_t vertex) const {
        auto const g = std::lower_bound(groups_.begin(), groups_.end() - 1, vertex,
                                        [this](std::size_t first, std::uint32_t v) { return fans_[first].at < v; });
        if (g == groups_.end() - 1 || fans_[*g].at != vertex) return nobody;
        return lonely_[static_cast<std::size_t>(g - groups_.begin())];
    }

    /// The corner across the edge to `next`.
    static std::size_t following(std::span<fan_corner const> fan, std::size_t k, bool apart) {
        std::size_t found = k;
        for (std::size_t j = 0; j < fan.size(); ++j) {
            if (fan[j].previous != fan[k].next) continue;
            found = j;
            if ((fan[j].inner == fan[k].inner) == apart) return j;
        }
        return found;
    }

    std::vector<fan_corner> fans_{};
    std::vector<std::size_t> groups_{};
    std::vector<std::uint32_t> lonely_{};
};

}  // namespace tafoni::detail

#endif
