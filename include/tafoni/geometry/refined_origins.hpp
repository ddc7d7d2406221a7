/// \file
/// Where the vertices and faces of a refined surface come from, for whoever carries own numbers along.
#ifndef TAFONI_GEOMETRY_REFINED_ORIGINS_HPP
#define TAFONI_GEOMETRY_REFINED_ORIGINS_HPP

#include <tafoni/core/index.hpp>
#include <tafoni/geometry/refine_faces.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace tafoni {

/// The way back from a surface that was refined, once or again and again, to the one that it was made from, whose vertices
/// keep their numbers.
struct refined_origins {
    /// Of each vertex behind those of the input, in order: the ends of the edge that it was put in the middle of. Both have
    /// lower numbers, but may have been added themselves.
    std::vector<std::array<std::uint32_t, 2>> midpoints{};
    std::vector<face_index> face{};  ///< of each triangle: that of the input which it lies in

    refined_origins() = default;
    /// Of a surface that is as it was given. O(faces).
    explicit refined_origins(std::size_t faces) {
        face.reserve(faces);
        for (std::size_t f = 0; f < faces; ++f) face.push_back(face_index{f});
    }

    /// Notes one refinement more; all or nothing. O(vertices added + faces).
    void follow(refined_faces const& fine) {
        std::vector<face_index> from;
        from.reserve(fine.parent.size());
        for (face_index const f : fine.parent) from.push_back(face[f.value]);
        midpoints.insert(midpoints.end(), fine.midpoints.begin(), fine.midpoints.end());
        face = std::move(from);
    }

    /// Numbers (or points, colours ...: what can be halved and added) of the input's vertices, and behind them those of the
    /// vertices added, each the mean of its two: texture coordinates, say. O(vertices).
    template <class T>
    [[nodiscard]] std::vector<T> carried(std::vector<T> of_input) const {
        of_input.reserve(of_input.size() + midpoints.size());
        for (auto const& [a, b] : midpoints) of_input.push_back(T(0.5 * of_input[a] + 0.5 * of_input[b]));
        return of_input;
    }
};

}  // namespace tafoni

#endif
