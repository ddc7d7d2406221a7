/// \file
/// Which shard a point lies in.
#ifndef TAFONI_DECOMPOSITION_LOCATE_HPP
#define TAFONI_DECOMPOSITION_LOCATE_HPP

#include <tafoni/decomposition/detail/loop_measure.hpp>
#include <tafoni/decomposition/shard_complex.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace tafoni {

/// Answers many questions about one complex, which must outlive it. A k-d tree over the sites.
///
/// A point belongs to the shard of its nearest site that wraps around it. Within 1e-12 of the model's
/// size of a bisector or of the skin either side may be the answer.
class shard_locator {
public:
    /// O(n log n) for n sites.
    explicit shard_locator(shard_complex const& complex) : complex_(&complex) {
        for (std::uint32_t s = 0; s < complex.sites.size(); ++s) {
            // A site without shards was dropped, or its cell lies outside: it is nearest to no point inside.
            if (!complex.shards_of(site_index{s}).empty()) order_.push_back(s);
        }
        axis_.resize(order_.size());
        build(0, order_.size());
    }

    /// The shard around p; not valid outside the solid. O(log n + corners of the shards of one site); where
    /// slivers were merged, O(corners of all) for points outside or in what was a sliver.
    [[nodiscard]] cell_index operator()(vec3 const& p) const {
        if (order_.empty()) return {};
        double best = std::numeric_limits<double>::infinity();
        visit(0, order_.size(), p, best, [&best](std::uint32_t, double d) {
            if (d < best) best = d;
        });
        // Sites that are as near but for rounding: the point lies on a bisector, their shards decide.
        double const slack = 1e-12 * complex_->size;
        double const reach = (std::sqrt(best) + slack) * (std::sqrt(best) + slack);
        std::vector<std::pair<double, std::uint32_t>> candidates;
        visit(0, order_.size(), p, reach, [&](std::uint32_t s, double d) {
            if (d <= reach) candidates.push_back({d, s});
        });
        std::sort(candidates.begin(), candidates.end());
        for (auto const& [distance, s] : candidates) {
            for (cell_index shard : complex_->shards_of(site_index{s})) {
                if (wraps(shard, p)) return shard;
            }
        }
        if (complex_->merged_slivers == 0) return {};
        for (std::uint32_t c = 0; c < complex_->cell_count(); ++c) {  // slivers went to shards of other sites
            if (wraps(cell_index{c}, p)) return cell_index{c};
        }
        return {};
    }

private:
    void build(std::size_t begin, std::size_t end) {
        if (end - begin < 2) return;
        box3 box;
        for (std::size_t k = begin; k < end; ++k) box.include(complex_->sites[order_[k]]);
        vec3 const size = box.extent();
        std::uint8_t axis = size[1] > size[0] ? 1 : 0;
        if (size[2] > size[axis]) axis = 2;
        std::size_t const mid = begin + (end - begin) / 2;
        auto const at = [&](std::size_t k) { return order_.begin() + static_cast<std::ptrdiff_t>(k); };
        std::nth_element(at(begin), at(mid), at(end), [&](std::uint32_t a, std::uint32_t b) {
            double const x = complex_->sites[a][axis];
            double const y = complex_->sites[b][axis];
            return x != y ? x < y : a < b;
        });
        axis_[mid] = axis;
        build(begin, mid);
        build(mid + 1, end);
    }

    /// Calls f(site, squared distance) on the sites that may be within the squared `reach`, which f may shorten.
    template <class F>
    void visit(std::size_t begin, std::size_t end, vec3 const& p, double const& reach, F const& f) const {
        if (begin == end) return;
        std::size_t const mid = begin + (end - begin) / 2;
        vec3 const& s = complex_->sites[order_[mid]];
        f(order_[mid], squared_length(vec3{p[0] - s[0], p[1] - s[1], p[2] - s[2]}));
        if (end - begin == 1) return;
        double const ahead = p[axis_[mid]] - s[axis_[mid]];
        if (ahead < 0) visit(begin, mid, p, reach, f);
        else visit(mid + 1, end, p, reach, f);
        if (ahead * ahead > reach) return;
        if (ahead < 0) visit(mid + 1, end, p, reach, f);
        else visit(begin, mid, p, reach, f);
    }

    [[nodiscard]] bool wraps(cell_index shard, vec3 const& p) const {
        auto const places = [this](vertex_index v) { return complex_->vertices[v.value]; };
        int winding = 0;
        for (std::uint32_t f : complex_->faces_of(shard)) {
            int const sign = complex_->faces[f].front == shard ? 1 : -1;
            for (std::size_t l = 0; l < complex_->loop_count(face_index{f}); ++l) {
                winding += sign * detail::winding_above(complex_->face_loop(face_index{f}, l), places, p);
            }
        }
        return winding != 0;
    }

    shard_complex const* complex_;
    std::vector<std::uint32_t> order_;
    std::vector<std::uint8_t> axis_;
};

namespace detail {

struct locate_fn {
    /// The shard around p; not valid outside the solid. O(n log n) in the sites: for many points keep a `shard_locator`.
    [[nodiscard]] cell_index operator()(shard_complex const& complex, vec3 const& p) const {
        return shard_locator(complex)(p);
    }
};

}  // namespace detail

/// Locates one point; see `detail::locate_fn`.
inline constexpr detail::locate_fn locate{};

}  // namespace tafoni

#endif
