/// \file
/// Sums over the triangles around every vertex, with one order of addition for every executor.
#ifndef TAFONI_CURVATURE_DETAIL_CORNER_SUMS_HPP
#define TAFONI_CURVATURE_DETAIL_CORNER_SUMS_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/curvature/concepts.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tafoni::detail {

inline constexpr std::size_t vertex_grain = 2048;

/// \throws invalid_input  `attribute_length` for other than one number per vertex, `bad_parameter` for rings of no or
///         another mesh.
inline void require_one_per_vertex(char const* who, surface_view const& s, std::size_t numbers) {
    std::size_t const vertices = s.positions.size();
    if (numbers != vertices) {
        fail<invalid_input>(errc::attribute_length,
                            std::string(who) + ": got " + std::to_string(numbers) + " numbers for " + std::to_string(vertices) +
                                " vertices",
                            {.kind = entity::attribute, .value = static_cast<double>(numbers),
                             .limit = static_cast<double>(vertices)});
    }
    if (s.rings == nullptr || s.rings->vertex_count() != vertices) {
        fail<invalid_input>(errc::bad_parameter, std::string(who) + ": the rings are not those of the surface",
                            {.kind = entity::parameter});
    }
}

/// `with(room)`, the surface's own or one for this call.
template <class With>
void with_room(surface_view const& s, With const& with) {
    if (s.room != nullptr) return with(*s.room);
    estimator_room fresh;
    with(fresh);
}

/// The vertices in consecutive shares, and the triangles that reach each of them, for threads that sum over corners.
///
/// A share is summed by one thread: it meets its triangles in ascending order, so that the sums are those of one thread.
/// A triangle between shares is worked out in each of them; in meshes whose vertices stand in some order those are few.
/// Every thread looks through all triangles for its own, which costs less than to fetch what others have found.
class corner_shares {
public:
    /// O(faces). Keeps 4 bytes of `room` per face and share, most of them never touched.
    template <executor E>
    corner_shares(surface_view const& s, estimator_room& room, E const& executor)
        : vertices_(s.positions.size()), faces_(s.triangles.size()),
          count_(std::clamp<std::size_t>(std::min(vertices_, faces_) / least, 1, std::min(executor.thread_count(), most))),
          found_(room, count_ > 1 ? count_ * faces_ : 0) {
        if (count_ == 1) return;
        executor.for_blocks(count_, 1, [&](std::size_t share, std::size_t) {
            std::size_t const first = begin(share);
            std::size_t const size = begin(share + 1) - first;
            std::uint32_t* const list = found_.begin() + share * faces_;
            std::size_t n = 0;
            for (std::size_t f = 0; f < faces_; ++f) {  // without a branch: triangles in no order go either way
                auto const [i, j, k] = s.triangles[f];
                bool const mine = (i - first < size) | (j - first < size) | (k - first < size);
                list[n] = static_cast<std::uint32_t>(f);
                n += mine ? 1U : 0U;
            }
            length_[share] = n;
        });
    }

    [[nodiscard]] std::size_t count() const noexcept { return count_; }
    [[nodiscard]] std::size_t begin(std::size_t share) const noexcept {
        return vertices_ / count_ * share + std::min(share, vertices_ % count_);
    }
    /// The triangles that reach a share, ascending.
    [[nodiscard]] std::span<std::uint32_t const> triangles(std::size_t share) const noexcept {
        return {found_.begin() + share * faces_, length_[share]};
    }

private:
    static constexpr std::size_t most = 16;
    static constexpr std::size_t least = 64;  ///< vertices in a share
    std::size_t vertices_;
    std::size_t faces_;
    std::size_t count_;
    estimator_room::array<std::uint32_t> found_;
    std::array<std::size_t, most> length_{};
};

/// `sum_corners` by one thread.
template <class Sum, class Source, class Finish>
void sum_all_corners(surface_view const& s, std::span<Sum> sums, Sum const& zero, Source const& source, Finish const& finish) {
    std::fill(sums.begin(), sums.end(), zero);
    auto const add = [&](std::size_t f, auto const& face, std::size_t which) __attribute__((always_inline)) {
        auto const [i, j, k] = s.triangles[f];
        add_to(sums[i], face.corner(0, which));
        add_to(sums[j], face.corner(1, which));
        add_to(sums[k], face.corner(2, which));
    };
    std::size_t const faces = s.triangles.size();
    for (std::size_t f = 0; f + 1 < faces; f += 2) {
        auto const two = source.of(f, f + 1);
        add(f, two, 0);
        add(f + 1, two, 1);
    }
    if (faces % 2 == 1) add(faces - 1, source.of(faces - 1), 0);
    for (std::size_t v = 0; v < sums.size(); ++v) finish(v, sums[v]);
}

/// `finish(v, sum)` for every vertex, with the sum over the corners at v, by ascending face, of what a face gives.
///
/// `source.of(f)` and `source.of(f, g)`, of two triangles side by side, have `corner(k, which)`, what is added to a `Sum`:
/// zeros for a triangle without area. `sums` has one entry per vertex. The same additions in the same order for every
/// number of shares. O(faces).
template <class Sum, class Source, executor E, class Finish>
void sum_corners(surface_view const& s, corner_shares const& shares, std::span<Sum> sums, Sum const& zero, Source const& source,
                 E const& executor, Finish const& finish) {
    if (shares.count() == 1) return sum_all_corners(s, sums, zero, source, finish);
    executor.for_blocks(shares.count(), 1, [&](std::size_t share, std::size_t) {
        std::size_t const begin = shares.begin(share);
        std::size_t const size = shares.begin(share + 1) - begin;
        Sum* const mine = sums.data() + begin;
        std::fill_n(mine, size, zero);
        Sum other = zero;  // what goes to the vertices of other shares, which see to it themselves
        auto const at = [&](std::size_t v) -> Sum& {
            std::array<Sum*, 2> const places{&other, sums.data() + v};  // no branch: between shares it goes either way
            return *places[v - begin < size ? 1 : 0];
        };
        auto const add = [&](std::size_t f, auto const& face, std::size_t which) __attribute__((always_inline)) {
            auto const [i, j, k] = s.triangles[f];
            add_to(at(i), face.corner(0, which));
            add_to(at(j), face.corner(1, which));
            add_to(at(k), face.corner(2, which));
        };
        std::span<std::uint32_t const> const list = shares.triangles(share);
        std::size_t n = 0;
        for (; n + 1 < list.size(); n += 2) {
            auto const two = source.of(list[n], list[n + 1]);
            add(list[n], two, 0);
            add(list[n + 1], two, 1);
        }
        if (n < list.size()) add(list[n], source.of(list[n]), 0);
        for (std::size_t v = 0; v < size; ++v) finish(begin + v, mine[v]);
    });
}

/// At every border vertex the mean of its inner neighbours; without any, that of the border vertices beside it that have
/// some; without those, what stands there stays. O(vertices).
template <executor E>
void fill_border(surface_view const& s, std::span<double> mean, E const& executor) {
    std::vector<unsigned char> filled(mean.size(), 0);
    auto const round = [&](auto const& mean_of, bool first) {
        executor.for_blocks(mean.size(), vertex_grain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t v = begin; v < end; ++v) {
                if (!s.rings->is_border(v) || filled[v] != 0) continue;
                double sum = 0;
                double count = 0;
                for (std::uint32_t const w : s.rings->neighbors(v)) {
                    if (!mean_of(w)) continue;
                    sum += mean[w];
                    count += 1;
                }
                if (!(count > 0)) continue;
                mean[v] = sum / count;
                if (first) filled[v] = 1;
            }
        });
    };
    round([&](std::uint32_t w) { return !s.rings->is_border(w); }, true);
    round([&](std::uint32_t w) { return filled[w] != 0; }, false);
}

}  // namespace tafoni::detail

#endif
