/// \file
/// Writes VTK XML polygonal data (.vtp): a mesh or a set of polylines with numbers per point and per cell.
#ifndef TAFONI_IO_WRITE_VTP_HPP
#define TAFONI_IO_WRITE_VTP_HPP

#include <tafoni/geometry/concepts.hpp>
#include <tafoni/io/detail/format_number.hpp>
#include <tafoni/io/detail/require_writable.hpp>
#include <tafoni/io/detail/write_file.hpp>
#include <tafoni/io/detail/xml.hpp>
#include <tafoni/io/mesh_file.hpp>
#include <tafoni/io/polyline_set.hpp>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tafoni {

struct write_vtp_options {
    coordinate_type coordinates = coordinate_type::float64;
    vec3 origin{0, 0, 0};  ///< for float32: subtracted, and recorded in the field data "origin"
};

namespace detail {

/// Collects the arrays of a .vtp: a description in XML, the numbers behind it as raw bytes.
class vtp_builder {
public:
    void open_piece(std::size_t points, std::size_t lines, std::size_t polygons, std::size_t vertices) {
        xml_ += "<Piece NumberOfPoints=\"" + std::to_string(points) + "\" NumberOfVerts=\"" + std::to_string(vertices) +
                "\" NumberOfLines=\"" + std::to_string(lines) + "\" NumberOfStrips=\"0\" NumberOfPolys=\"" +
                std::to_string(polygons) + "\">\n";
    }
    void open(std::string_view tag) { ((xml_ += '<') += tag) += ">\n"; }
    void close(std::string_view tag) { ((xml_ += "</") += tag) += ">\n"; }

    /// One array; `fill` appends its bytes.
    template <class Fill>
    void array(std::string_view type, std::string_view name, std::size_t components, std::size_t tuples, Fill&& fill) {
        xml_ += "<DataArray type=\"" + std::string(type) + "\" Name=\"" + xml_escaped(name) + "\"";
        if (components != 1) xml_ += " NumberOfComponents=\"" + std::to_string(components) + "\"";
        if (tuples != 0) xml_ += " NumberOfTuples=\"" + std::to_string(tuples) + "\"";
        xml_ += " format=\"appended\" offset=\"" + std::to_string(blob_.size()) + "\"/>\n";
        std::size_t const start = blob_.size();
        append_little(blob_, std::uint64_t{0});
        fill(blob_);
        std::string length;
        append_little(length, static_cast<std::uint64_t>(blob_.size() - start - 8));
        blob_.replace(start, 8, length);
    }

    /// Offsets and corners of cells. `size(i)` and `corner(i, k)` describe cell i.
    template <class Size, class Corner>
    void cells(std::string_view tag, std::size_t count, Size&& size, Corner&& corner) {
        open(tag);
        array("Int64", "connectivity", 1, 0, [&](std::string& out) {
            for (std::size_t i = 0; i < count; ++i) {
                for (std::size_t k = 0; k < size(i); ++k) append_little(out, static_cast<std::int64_t>(corner(i, k)));
            }
        });
        array("Int64", "offsets", 1, 0, [&](std::string& out) {
            std::int64_t end = 0;
            for (std::size_t i = 0; i < count; ++i) append_little(out, end += static_cast<std::int64_t>(size(i)));
        });
        close(tag);
    }

    /// Numbers per point or cell. nx, ny, nz together become the array "Normals"; the first other
    /// channel is the one that viewers colour by.
    void channels(std::string_view tag, std::vector<mesh_channel> const& list) {
        mesh_channel const* const n[] = {mesh_attributes::find(list, "nx"), mesh_attributes::find(list, "ny"),
                                         mesh_attributes::find(list, "nz")};
        bool const normals = n[0] != nullptr && n[1] != nullptr && n[2] != nullptr;
        auto const is_normal = [&](mesh_channel const& c) { return normals && (&c == n[0] || &c == n[1] || &c == n[2]); };
        (xml_ += '<') += tag;
        for (mesh_channel const& c : list) {
            if (is_normal(c)) continue;
            xml_ += " Scalars=\"" + xml_escaped(c.name) + "\"";
            break;
        }
        xml_ += normals ? " Normals=\"Normals\">\n" : ">\n";
        static constexpr std::string_view types[] = {"Int8",  "UInt8",  "Int16",   "UInt16",
                                                     "Int32", "UInt32", "Float32", "Float64"};
        for (mesh_channel const& c : list) {
            if (is_normal(c)) continue;
            array(types[static_cast<std::size_t>(c.type)], c.name, 1, 0, [&](std::string& out) {
                for (double const v : c.values) as_type(c.type, v, [&](auto number) { append_little(out, number); });
            });
        }
        if (normals) {
            array("Float32", "Normals", 3, 0, [&](std::string& out) {
                for (std::size_t i = 0; i < n[0]->values.size(); ++i) {
                    for (mesh_channel const* c : n) append_little(out, static_cast<float>(c->values[i]));
                }
            });
        }
        close(tag);
    }

    template <class Position>
    void points(std::size_t count, write_vtp_options const& options, Position&& position) {
        require_finite_vertex("write_vtp (origin)", options.origin, 0);
        bool const single = options.coordinates == coordinate_type::float32;
        vec3 const origin = single ? float_origin(options.origin) : vec3{0, 0, 0};
        open("Points");
        array(single ? "Float32" : "Float64", "Points", 3, 0, [&](std::string& out) {
            for (std::size_t v = 0; v < count; ++v) {
                vec3 const p = position(v);
                if (single) require_float_vertex("write_vtp", p, origin, v);
                for (int axis = 0; axis < 3; ++axis) {
                    if (single) {
                        append_little(out, static_cast<float>(p[axis] - origin[axis]));
                    } else {
                        append_little(out, p[axis]);
                    }
                }
            }
        });
        close("Points");
        if (!(origin == vec3{0, 0, 0})) origin_ = origin;
    }

    [[nodiscard]] std::string finish() {
        std::string field;
        if (!(origin_ == vec3{0, 0, 0})) {
            std::swap(field, xml_);
            open("FieldData");
            array("Float64", "origin", 3, 1, [&](std::string& out) {
                for (int axis = 0; axis < 3; ++axis) append_little(out, origin_[axis]);
            });
            close("FieldData");
            std::swap(field, xml_);
        }
        std::string out =
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
            "header_type=\"UInt64\">\n<PolyData>\n";
        out.reserve(out.size() + field.size() + xml_.size() + blob_.size() + 128);
        ((out += field) += xml_) += "</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_";
        (out += blob_) += "\n</AppendedData>\n</VTKFile>\n";
        return out;
    }

private:
    std::string xml_{};
    std::string blob_{};
    vec3 origin_{0, 0, 0};
};

}  // namespace detail

/// The mesh as the bytes of a .vtp. Channels keep name and type; of the rest of the attributes
/// nothing is written. A mesh without faces is written as one point cell per vertex.
/// O(vertices + corners + values).
/// \throws invalid_input  `non_finite_vertex`, `index_out_of_range`, `degenerate_face`, `attribute_length`, `bad_parameter`.
/// \throws io_error       `format_limit` where float32 cannot hold a coordinate.
template <polygon_mesh M>
[[nodiscard]] std::string encode_vtp(M const& mesh, mesh_attributes const& attributes = {},
                                     write_vtp_options const& options = {}) {
    using access = mesh_access<M>;
    detail::require_writable("write_vtp", mesh, attributes);
    std::size_t const points = access::vertex_count(mesh);
    std::size_t const faces = access::face_count(mesh);
    detail::vtp_builder out;
    out.open_piece(points, 0, faces, faces == 0 ? points : 0);
    out.channels("PointData", attributes.vertex_channels);
    out.channels("CellData", attributes.face_channels);
    out.points(points, options, [&](std::size_t v) { return access::position(mesh, v); });
    if (faces == 0) {
        out.cells("Verts", points, [](std::size_t) { return std::size_t{1}; },
                  [](std::size_t i, std::size_t) { return std::uint64_t{i}; });
    }
    out.cells("Polys", faces, [&](std::size_t f) { return access::face_size(mesh, f); },
              [&](std::size_t f, std::size_t k) { return access::corner(mesh, f, k); });
    return out.finish();
}

/// Polylines as the bytes of a .vtp: `point_channels` are parallel to the points, `line_channels` to the lines.
/// O(points + corners + values). \throws invalid_input, io_error  as for a mesh.
[[nodiscard]] inline std::string encode_vtp(polyline_set const& lines,
                                            std::vector<mesh_channel> const& point_channels = {},
                                            std::vector<mesh_channel> const& line_channels = {},
                                            write_vtp_options const& options = {}) {
    constexpr char const* who = "write_vtp";
    std::size_t const points = lines.positions.size();
    for (std::size_t v = 0; v < points; ++v) detail::require_finite_vertex(who, lines.positions[v], v);
    for (std::uint32_t const c : lines.corners) {
        if (c >= points) {
            detail::fail<invalid_input>(errc::index_out_of_range,
                                        std::string(who) + ": a line has point " + std::to_string(c) + " of " +
                                            std::to_string(points),
                                        {.kind = entity::vertex, .value = double(c), .limit = double(points) - 1});
        }
    }
    bool ordered = lines.offsets.empty() ? lines.corners.empty()
                                         : lines.offsets.front() == 0 && lines.offsets.back() == lines.corners.size();
    for (std::size_t i = 1; i < lines.offsets.size(); ++i) ordered = ordered && lines.offsets[i - 1] <= lines.offsets[i];
    if (!ordered) detail::fail<invalid_input>(errc::bad_parameter, "write_vtp: the offsets of the lines must rise from 0 to the number of corners");
    detail::require_channels(who, point_channels, points, "point");
    detail::require_channels(who, line_channels, lines.line_count(), "line");
    detail::vtp_builder out;
    out.open_piece(points, lines.line_count(), 0, 0);
    out.channels("PointData", point_channels);
    out.channels("CellData", line_channels);
    out.points(points, options, [&](std::size_t v) { return lines.positions[v]; });
    out.cells("Lines", lines.line_count(), [&](std::size_t i) { return lines.offsets[i + 1] - lines.offsets[i]; },
              [&](std::size_t i, std::size_t k) { return lines.corners[lines.offsets[i] + k]; });
    return out.finish();
}

/// Writes a mesh as .vtp, atomically. \throws invalid_input, io_error  as `encode_vtp`, and `write_failed`, `not_a_file`.
template <polygon_mesh M>
void write_vtp(std::filesystem::path const& path, M const& mesh, mesh_attributes const& attributes = {},
               write_vtp_options const& options = {}) {
    detail::write_file("write_vtp", path, encode_vtp(mesh, attributes, options));
}

/// Writes polylines as .vtp, atomically. \throws invalid_input, io_error  as above.
inline void write_vtp(std::filesystem::path const& path, polyline_set const& lines,
                      std::vector<mesh_channel> const& point_channels = {},
                      std::vector<mesh_channel> const& line_channels = {}, write_vtp_options const& options = {}) {
    detail::write_file("write_vtp", path, encode_vtp(lines, point_channels, line_channels, options));
}

}  // namespace tafoni

#endif
