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
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tafoni::detail {

inline constexpr std::size_t face_grain = 4096;
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

/// Room for numbers, not initialised, that the calling thread keeps for its next call: fresh pages cost several threads
/// more than the sums that they hold. A call from within the use of one gets room of its own.
template <class T>
class kept_array {
public:
    explicit kept_array(std::size_t size) : mine_(std::move(kept())) {
        if (mine_.size < size) {
            mine_.data.reset();
            mine_.size = 0;
            mine_.data = std::make_unique_for_overwrite<T[]>(size);
            mine_.size = size;
        }
    }
    kept_array(kept_array const&) = delete;
    kept_array& operator=(kept_array const&) = delete;
    ~kept_array() { kept() = std::move(mine_); }

    [[nodiscard]] T& operator[](std::size_t i) const noexcept { return mine_.data[i]; }

private:
    struct room {
        std::unique_ptr<T[]> data{};
        std::size_t size = 0;

        room() = default;
        room(room&& other) noexcept : data(std::move(other.data)), size(std::exchange(other.size, 0)) {}
        room& operator=(room&& other) noexcept {
            data = std::move(other.data);
            size = std::exchange(other.size, 0);
            return *this;
        }
    };
    static room& kept() {
        static thread_local room one;
        return one;
    }
    room mine_;
};

/// `finish(v, sum)` for every vertex, with the sum over the corners at v, by ascending face, of what a face gives.
///
/// `source.of(f)` and `source.of(f, g)`, of two triangles side by side, have `corner(k, which)`, what is added to a `Sum`
/// (zeros for a triangle without area), and `part(which)`, what is kept of it in between; `source.of(f, part)` gives it again. One thread adds corners as the faces come, in `sums` (one entry per vertex; of several threads none);
/// several keep the parts and gather: the same additions in the same order. O(faces).
template <class Sum, class Source, executor E, class Finish>
void sum_corners(surface_view const& s, std::span<Sum> sums, Sum const& zero, Source const& source, E const& executor,
                 Finish const& finish) {
    std::size_t const faces = s.triangles.size();
    std::size_t const vertices = s.positions.size();
    if (executor.thread_count() <= 1) {
        std::fill(sums.begin(), sums.end(), zero);
        for (std::size_t f = 0; f + 1 < faces; f += 2) {
            auto const two = source.of(f, f + 1);
            for (std::size_t k = 0; k < 3; ++k) add_to(sums[s.triangles[f][k]], two.corner(k, 0));
            for (std::size_t k = 0; k < 3; ++k) add_to(sums[s.triangles[f + 1][k]], two.corner(k, 1));
        }
        if (faces % 2 == 1) {
            auto const last = source.of(faces - 1);
            for (std::size_t k = 0; k < 3; ++k) add_to(sums[s.triangles[faces - 1][k]], last.corner(k, 0));
        }
        for (std::size_t v = 0; v < vertices; ++v) finish(v, sums[v]);
        return;
    }
    kept_array<decltype(source.of(faces).part(faces))> const parts(faces);
    executor.for_blocks(faces, face_grain, [&](std::size_t begin, std::size_t end) {
        std::size_t f = begin;
        for (; f + 1 < end; f += 2) {
            auto const two = source.of(f, f + 1);
            parts[f] = two.part(0);
            parts[f + 1] = two.part(1);
        }
        if (f < end) parts[f] = source.of(f).part(0);
    });
    executor.for_blocks(vertices, vertex_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
            Sum sum = zero;
            for (auto const& c : s.rings->faces(v)) add_to(sum, source.of(c.face, parts[c.face]).corner(c.place, 0));
            finish(v, sum);
        }
    });
}

/// Scratch for `sum_corners`.
template <class Sum, executor E>
[[nodiscard]] std::vector<Sum> corner_scratch(surface_view const& s, E const& executor) {
    return std::vector<Sum>(executor.thread_count() <= 1 ? s.positions.size() : 0);
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
