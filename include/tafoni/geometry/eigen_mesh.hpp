/// \file
/// Reads Eigen's usual pair of matrices, V with a vertex and F with a face per row, without copying.
#ifndef TAFONI_GEOMETRY_EIGEN_MESH_HPP
#define TAFONI_GEOMETRY_EIGEN_MESH_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/geometry/concepts.hpp>

#include <Eigen/Core>

#include <concepts>
#include <cstdint>
#include <string>
#include <type_traits>

namespace tafoni {

/// V (n x 3, float or double) and F (m x k, any integer), row- or column-major. Faces have k corners;
/// negative entries at the end of a row make a face shorter, as in libigl's mixed lists.
/// Holds references: the matrices must outlive the view.
template <class V, class F>
struct eigen_mesh {
    V const& vertices;
    F const& faces;
};

namespace detail {

template <class V, class F>
struct eigen_rows {
    using mesh = eigen_mesh<V, F>;

    static std::size_t vertex_count(mesh const& m) { return static_cast<std::size_t>(m.vertices.rows()); }
    static vec3 position(mesh const& m, std::size_t v) {
        auto const r = static_cast<Eigen::Index>(v);
        return vec3{static_cast<double>(m.vertices(r, 0)), static_cast<double>(m.vertices(r, 1)),
                    static_cast<double>(m.vertices(r, 2))};
    }
    static std::size_t face_count(mesh const& m) { return static_cast<std::size_t>(m.faces.rows()); }
    static std::uint64_t corner(mesh const& m, std::size_t f, std::size_t k) {
        return static_cast<std::uint64_t>(m.faces(static_cast<Eigen::Index>(f), static_cast<Eigen::Index>(k)));
    }
};

}  // namespace detail

template <class V, class F>
struct mesh_access<eigen_mesh<V, F>> : detail::eigen_rows<V, F> {
    static std::size_t face_size(eigen_mesh<V, F> const& m, std::size_t f) {
        auto n = m.faces.cols();
        if constexpr (std::is_signed_v<typename F::Scalar>) {
            while (n > 3 && m.faces(static_cast<Eigen::Index>(f), n - 1) < 0) --n;
        }
        return static_cast<std::size_t>(n);
    }
};

/// As above, with exactly three columns at compile time.
template <class V, class F>
    requires(F::ColsAtCompileTime == 3)
struct mesh_access<eigen_mesh<V, F>> : detail::eigen_rows<V, F> {
    static constexpr std::size_t corners_per_face = 3;
    static std::size_t face_size(eigen_mesh<V, F> const&, std::size_t) { return 3; }
};

/// A view of V and F, which may be matrices, maps, blocks or refs with entries in memory.
/// \throws invalid_input  attribute_length: V has not 3 columns, or F fewer than 3. O(1).
template <class V, class F>
    requires std::floating_point<typename V::Scalar> && std::integral<typename F::Scalar>
[[nodiscard]] eigen_mesh<V, F> view_matrices(Eigen::DenseBase<V> const& vertices, Eigen::DenseBase<F> const& faces) {
    auto const require = [](bool good, char const* what, Eigen::Index got) {
        if (good) return;
        detail::fail<invalid_input>(errc::attribute_length,
                                    std::string("view_matrices: ") + what + ", got " + std::to_string(got),
                                    {.kind = entity::attribute, .value = static_cast<double>(got), .limit = 3});
    };
    require(vertices.cols() == 3, "V needs 3 columns", vertices.cols());
    require(faces.cols() >= 3 || faces.rows() == 0, "F needs at least 3 columns", faces.cols());
    return {vertices.derived(), faces.derived()};
}

/// A temporary would be gone before the view is read.
template <class V, class F>
void view_matrices(Eigen::DenseBase<V>&&, Eigen::DenseBase<F> const&) = delete;
template <class V, class F>
void view_matrices(Eigen::DenseBase<V> const&, Eigen::DenseBase<F>&&) = delete;
template <class V, class F>
void view_matrices(Eigen::DenseBase<V>&&, Eigen::DenseBase<F>&&) = delete;

namespace detail {
using matrix_v = Eigen::Matrix<double, Eigen::Dynamic, 3>;
using matrix_f = Eigen::Matrix<int, Eigen::Dynamic, 3>;
}  // namespace detail

static_assert(triangle_mesh<eigen_mesh<detail::matrix_v, detail::matrix_f>>);
static_assert(polygon_mesh<eigen_mesh<Eigen::MatrixXf, Eigen::MatrixXi>>);

}  // namespace tafoni

#endif
