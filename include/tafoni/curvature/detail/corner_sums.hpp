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
class corner_shares {
public:
    /// O(faces). Keeps 4 bytes of `room` per face and share, most of them never touched.
    template <executor E>
    corner_shares(surface_view const& s, estimator_room& room, E const& executor)
        : vertices_(s.positions.size()), faces_(s.triangles.size()),
          count_(std::clamp<std::size_t>(std::min(vertices_, faces_) / least, 1, std::min(executor.thread_count(), most))),
          scale_((std::uint64_t{count_} << 32) / std::max<std::size_t>(vertices_, 1)), chunks_((faces_ + chunk - 1) / chunk),
          faces_of_(room, count_ > 1 ? count_ * chunks_ * chunk : 0), length_(room, count_ > 1 ? chunks_ : 0) {
        if (count_ == 1) return;
        executor.for_blocks(faces_, chunk, [&](std::size_t begin, std::size_t end) {
            std::array<std::uint32_t, most> n{};
            std::uint32_t* const list = faces_of_.begin() + begin * count_;
            auto const add = [&](std::size_t share, std::size_t f) { list[share * chunk + n[share]++] = static_cast<std::uint32_t>(f); };
            for (std::size_t f = begin; f < end; ++f) {
                auto const& t = s.triangles[f];
                std::size_t const i = of(t[0]);
                std::size_t const j = of(t[1]);
                std::size_t const k = of(t[2]);
                add(i, f);
                if (i == j && j == k) continue;
                if (j != i) add(j, f);
                if (k != i && k != j) add(k, f);
            }
            length_[begin / chunk] = n;
        });
    }

    [[nodiscard]] std::size_t count() const noexcept { return count_; }
    [[nodiscard]] std::size_t begin(std::size_t share) const noexcept {
        return share == count_ ? vertices_ : static_cast<std::size_t>(((std::uint64_t{share} << 32) + scale_ - 1) / scale_);
    }
    /// `f(list)` for the ascending lists of triangles that together reach a share, themselves ascending.
    template <class F>
    void for_lists(std::size_t share, F const& f) const {
        for (std::size_t c = 0; c < chunks_; ++c) {
            f(std::span<std::uint32_t const>(faces_of_.begin() + (c * count_ + share) * chunk, length_[c][share]));
        }
    }

private:
    [[nodiscard]] std::size_t of(std::uint32_t v) const noexcept { return static_cast<std::size_t>((v * scale_) >> 32); }

    static constexpr std::size_t chunk = 2048;
    static constexpr std::size_t most = 16;
    static constexpr std::size_t least = 64;  ///< vertices in a share
    std::size_t vertices_;
    std::size_t faces_;
    std::size_t count_;
    std::uint64_t scale_;
    std::size_t chunks_;
    estimator_room::array<std::uint32_t> faces_of_;
    estimator_room::array<std::array<std::uint32_t, most>> length_;
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
        shares.for_lists(share, [&](std::span<std::uint32_t const> list) {
            std::size_t k = 0;
            for (; k + 1 < list.size(); k += 2) {
                auto const two = source.of(list[k], list[k + 1]);
                add(list[k], two, 0);
                add(list[k + 1], two, 1);
            }
            if (k < list.size()) add(list[k], source.of(list[k]), 0);
        });
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
