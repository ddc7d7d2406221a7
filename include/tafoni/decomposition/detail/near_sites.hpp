/// \file
/// The sites around a leaf of a site tree.
#ifndef TAFONI_DECOMPOSITION_DETAIL_NEAR_SITES_HPP
#define TAFONI_DECOMPOSITION_DETAIL_NEAR_SITES_HPP

#include <tafoni/decomposition/detail/site_tree.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tafoni::detail {

/// All sites within a distance of a leaf, which its sites share; single precision, relative to its corner,
/// in units of 1 / `scale`, a power of two not above the spacing of the leaf's sites.
class near_sites {
public:
    [[nodiscard]] static double distance2(site_tree::node const& a, site_tree::node const& b) noexcept {
        double s = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            auto const gap = static_cast<double>(std::max({b.lo[k] - a.hi[k], a.lo[k] - b.hi[k], std::int64_t{0}}));
            s += gap * gap;
        }
        return s;
    }

    /// Takes the sites within sqrt(reach2) of the leaf `home`, but for those in [skip, skip_end). O(result + log n) for even sites.
    void gather(std::span<ivec3 const> sites, site_tree const& tree, site_tree::node const& home, double reach2,
                std::uint32_t skip, std::uint32_t skip_end) {
        size_ = 0;
        corner_ = home.lo;
        scale_ = home.spacing > 0 ? std::ldexp(1.0, -std::ilogb(home.spacing)) : 1;
        for (std::uint32_t k = 0; k < tree.nodes.size();) {
            site_tree::node const& v = tree.nodes[k];
            if ((v.begin >= skip && v.end <= skip_end) || distance2(home, v) > reach2) {
                k = v.skip;
                continue;
            }
            if (tree.is_leaf(k)) {
                if (id_.size() < size_ + site_tree::leaf_size) {
                    std::size_t const n = 2 * (size_ + site_tree::leaf_size);
                    id_.resize(n);
                    for (auto& c : at_) c.resize(n);
                }
                if (v.begin == home.begin) home_ = size_;
                for (std::uint32_t s = v.begin; s < v.end; ++s, ++size_) {
                    id_[size_] = s;
                    for (std::size_t a = 0; a < 3; ++a) at_[a][size_] = single(sites[s][a] - home.lo[a]);
                }
            }
            ++k;
        }
    }

    [[nodiscard]] std::size_t size() const noexcept { return size_; }
    [[nodiscard]] std::size_t home() const noexcept { return home_; }  ///< place of the leaf's first site
    [[nodiscard]] std::uint32_t id(std::size_t k) const noexcept { return id_[k]; }
    [[nodiscard]] double scale() const noexcept { return scale_; }
    [[nodiscard]] float const* x() const noexcept { return at_[0].data(); }
    [[nodiscard]] float const* y() const noexcept { return at_[1].data(); }
    [[nodiscard]] float const* z() const noexcept { return at_[2].data(); }
    [[nodiscard]] std::array<float, 3> relative(ivec3 const& p) const noexcept {
        return {single(p[0] - corner_[0]), single(p[1] - corner_[1]), single(p[2] - corner_[2])};
    }

private:
    [[nodiscard]] float single(std::int64_t v) const noexcept { return static_cast<float>(static_cast<double>(v) * scale_); }

    std::size_t size_ = 0;
    std::size_t home_ = 0;
    double scale_ = 1;
    ivec3 corner_{};
    std::vector<std::uint32_t> id_;
    std::array<std::vector<float>, 3> at_;
};

}  // namespace tafoni::detail

#endif
