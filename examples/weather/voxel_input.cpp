#include "voxel_input.hpp"

#include "input.hpp"
#include "read_png.hpp"
#include "spec.hpp"

#include <tafoni/geometry/repair_solid.hpp>
#include <tafoni/io/esri_ascii.hpp>
#include <tafoni/io/fill_from_vox.hpp>
#include <tafoni/io/read_mesh.hpp>
#include <tafoni/io/read_nrrd.hpp>
#include <tafoni/io/read_pgm.hpp>
#include <tafoni/io/read_vox.hpp>
#include <tafoni/voxel/fill_from_heights.hpp>
#include <tafoni/voxel/fill_from_image.hpp>
#include <tafoni/voxel/fill_from_mesh.hpp>
#include <tafoni/voxel/fill_from_predicate.hpp>
#include <tafoni/voxel/fill_from_solid.hpp>
#include <tafoni/voxel/frame_for.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

namespace weather {

using namespace tafoni;

namespace {

up_axis axis_of(std::string const& name) {
    if (name == "x") return up_axis::plus_x;
    if (name == "y") return up_axis::plus_y;
    if (name == "-x") return up_axis::minus_x;
    if (name == "-y") return up_axis::minus_y;
    return name == "-z" ? up_axis::minus_z : up_axis::plus_z;
}

/// The side of the user's grid, -x, +x, ..., that lies below.
std::size_t base_side(up_axis up) {
    switch (up) {
        case up_axis::plus_x: return 0;
        case up_axis::minus_x: return 1;
        case up_axis::plus_y: return 2;
        case up_axis::minus_y: return 3;
        case up_axis::plus_z: return 4;
        case up_axis::minus_z: break;
    }
    return 5;
}

grid_border border_of(std::string const& name, up_axis up) {
    grid_border out;
    if (name == "open") return out;
    std::size_t const base = base_side(up);
    if (name == "extend") out.sides.fill(border_kind::extend);
    out.sides[base ^ 1] = border_kind::air;
    out.sides[base] = border_kind::rock;
    return out;
}

std::size_t margin_of(voxel_arguments const& a) {
    return a.margin != voxel_arguments::unset ? a.margin : a.colluvium ? std::max<std::size_t>(a.resolution / 4, 2) : 2;
}

/// Voxels of air around the rock; none below rock that stands on the ground or goes on beyond the sides.
std::array<std::size_t, 6> padding_of(voxel_arguments const& a, voxel_source const& source) {
    std::size_t const margin = margin_of(a);
    std::size_t const base = base_side(source.up);
    std::array<std::size_t, 6> padding;
    padding.fill(source.border == "extend" ? 0 : margin);
    if (source.border != "open") padding[base] = 0;
    padding[base ^ 1] = std::max<std::size_t>(std::min<std::size_t>(margin, 2), 1);
    return padding;
}

template <class Fill>
void voxelise_by(voxel_source& source, voxel_arguments const& a, Fill fill) {
    source.voxelise = [frame = frame_for(source.bounds, a.resolution, padding_of(a, source)), up = source.up, border = border_of(source.border, source.up), fill] {
        sparse_grid grid(frame, up, border);
        fill(grid);
        return grid;
    };
}

void load_builtin(voxel_source& source, voxel_arguments const& a) {
    builtin_shape const shape = make_builtin(a.input.substr(8), a.seed);
    up_rotation const turn = up_rotation::of(source.up);
    source.bounds.lo = turn.direction_to_user(shape.bounds.lo);
    source.bounds.hi = turn.direction_to_user(shape.bounds.hi);
    for (int k = 0; k < 3; ++k) {
        if (source.bounds.lo[k] > source.bounds.hi[k]) std::swap(source.bounds.lo[k], source.bounds.hi[k]);
    }
    voxelise_by(source, a, [shape, turn](sparse_grid& grid) {
        fill_from_predicate(grid, [&](vec3 const& p) {
            vec3 own;
            for (std::size_t k = 0; k < 3; ++k) {
                double const x = p[turn.axis[k]];
                own[static_cast<Eigen::Index>(k)] = turn.mirrored[k] ? -x : x;
            }
            return shape.contains(own);
        });
    });
}

/// Terrain goes on beyond its sides; some rock lies below its lowest height.
void load_terrain(voxel_source& source, voxel_arguments const& a) {
    if (source.up != up_axis::plus_z) throw usage_error("--up " + a.up + ": terrain has its heights along z");
    if (source.border != "extend") throw usage_error("--border " + source.border + ": terrain extends beyond its sides");
    auto const heights = std::make_shared<height_grid const>(read_esri_ascii(std::filesystem::path(a.input)));
    double const longest = std::max(static_cast<double>(heights->columns) * heights->cell_size_x, static_cast<double>(heights->rows) * heights->cell_size_y);
    for (std::size_t r = 0; r < heights->rows; ++r) {
        for (std::size_t c = 0; c < heights->columns; ++c) {
            if (heights->has_height(r, c)) source.bounds.include(heights->position(r, c));
        }
    }
    terrain_grid_options const o{.resolution = a.resolution, .base = std::max(longest / 16, 4 * longest / static_cast<double>(a.resolution))};
    source.voxelise = [heights, o] { return fill_from_heights(*heights, o); };
}

/// An image, swept or revolved, about 1 per pixel.
void load_image(voxel_source& source, voxel_arguments const& a, bool png) {
    if (source.up != up_axis::plus_z) throw usage_error("--up " + a.up + ": images stand along z");
    auto const image = std::make_shared<gray_image const>(png ? read_png(a.input) : read_pgm(std::filesystem::path(a.input)));
    spec s = spec::parse("--image", a.image);
    image_options o{.resolution = a.resolution, .padding = margin_of(a)};
    if (s.name() == "revolve") {
        o.sweep = s.word("axis", "middle") == "left" ? image_sweep::around_left_edge : image_sweep::around_middle;
    } else if (s.name() == "sweep") {
        o.sweep = image_sweep::along_y;
        double const wide = static_cast<double>(image->width) * static_cast<double>(a.resolution) / static_cast<double>(std::max(image->width, image->height));
        o.depth = static_cast<std::size_t>(std::max(1.0, s.number("depth", 1, 1e-3, 1e3) * wide));
    } else {
        s.fail("known: revolve, sweep");
    }
    o.darkest_air = static_cast<std::uint8_t>(s.number("dark", 128, 0, 255));
    s.done();
    grid_frame const frame = frame_for_image(*image, o);
    auto const pad = static_cast<double>(o.padding);
    source.bounds.lo = {frame.origin[0] + pad, frame.origin[1] + pad, 0};
    source.bounds.hi = {-source.bounds.lo[0], -source.bounds.lo[1], static_cast<double>(frame.size[2]) - pad};
    if (source.border != "ground") throw usage_error("--border " + source.border + ": images stand on the ground");
    source.voxelise = [frame, image, o, border = border_of(source.border, source.up)] {
        sparse_grid grid(frame, up_axis::plus_z, border);
        fill_from_image(grid, *image, o);
        return grid;
    };
}

/// Voxels as they are in the file, in a margin of air; `is_rock` is asked in the file's own grid.
template <class IsRock>
void load_given(voxel_source& source, voxel_arguments const& a, grid_frame own, IsRock is_rock) {
    grid_frame frame = own;
    auto const padding = padding_of(a, source);
    for (std::size_t d = 0; d < 3; ++d) {
        auto const e = static_cast<Eigen::Index>(d);
        frame.size[d] += padding[2 * d] + padding[2 * d + 1];
        frame.origin[e] -= frame.spacing[e] * static_cast<double>(padding[2 * d]);
        source.bounds.lo[e] = own.origin[e];
        source.bounds.hi[e] = own.origin[e] + own.spacing[e] * static_cast<double>(own.size[d]);
    }
    source.voxelise = [=, up = source.up, border = border_of(source.border, source.up)] {
        sparse_grid grid(frame, up, border);
        for (std::size_t b = 0; b < grid.brick_count(); ++b) {
            grid.fill_brick(b, [&](voxel v) {
                voxel const u = grid.to_user(v);
                voxel const inner{u.x - static_cast<std::int32_t>(padding[0]), u.y - static_cast<std::int32_t>(padding[2]),
                                  u.z - static_cast<std::int32_t>(padding[4])};
                return own.contains(inner) && is_rock(inner) ? voxel_state::rock : voxel_state::air;
            });
        }
        return grid;
    };
}

void load_volume(voxel_source& source, voxel_arguments const& a) {
    auto const volume = std::make_shared<sample_volume const>(tafoni::read_nrrd(std::filesystem::path(a.input)));
    volume->validate();
    double level = a.level;
    if (std::isnan(level)) {
        auto const [least, largest] = std::minmax_element(volume->samples.begin(), volume->samples.end());
        level = 0.5 * (double{*least} + double{*largest});
    }
    load_given(source, a, volume->frame, [volume, level](voxel v) {
        return double{volume->at(static_cast<std::size_t>(v.x), static_cast<std::size_t>(v.y), static_cast<std::size_t>(v.z))} >= level;
    });
}

void load_vox(voxel_source& source, voxel_arguments const& a) {
    vox_file const file = read_vox(std::filesystem::path(a.input));
    if (file.models.empty()) {
        detail::fail<io_error>(errc::empty_input, a.input + ": no model in it", {.kind = entity::file, .file = a.input});
    }
    auto const model = std::make_shared<vox_model const>(file.models.front());
    auto const grid = std::make_shared<sparse_grid>(grid_frame{.size = model->size});
    fill_from_vox(*grid, *model);
    load_given(source, a, grid->user_frame(), [grid](voxel v) { return grid->is_solid(v); });
}

void load_solid(voxel_source& source, voxel_arguments const& a, solid&& body) {
    source.bounds = body.bounds;
    voxelise_by(source, a, [body = std::make_shared<solid const>(std::move(body))](sparse_grid& grid) { fill_from_solid(grid, *body); });
}

/// A solid; or a surface with holes or with edges of many faces, which is filled by its winding number, and told.
void load_mesh(voxel_source& source, voxel_arguments const& a) {
    auto const file = std::make_shared<mesh_file const>(
        read_model(a.input, "an elevation grid (.asc), voxels (.vox .nrrd), an image (.png .pgm) or builtin:SPEC"));
    try {
        repaired_solid r = repair_solid(file->mesh, {.orient = true});
        source.repaired["turned_faces"] = r.report.turned_faces.size();
        load_solid(source, a, std::move(r.body));
        return;
    } catch (bad_topology const& e) {
        constexpr std::array filled{errc::not_closed, errc::nonmanifold_edge, errc::nonmanifold_vertex, errc::duplicate_face};
        if (std::find(filled.begin(), filled.end(), e.code()) == filled.end()) throw;
    }
    sparse_grid probe(grid_frame{.size = {1, 1, 1}});
    mesh_fill_report const report = fill_from_mesh(probe, file->mesh);
    if (!(report.volume > 0)) {
        detail::fail<bad_topology>(errc::zero_volume, a.input + ": the surface encloses no volume", {.kind = entity::file, .file = a.input});
    }
    source.repaired = {{"turned_faces", 0}, {"holes", report.holes}, {"open_edges", report.boundary_edges}, {"filled_by_winding_number", 1}};
    for (vec3 const& p : file->mesh.positions) source.bounds.include(p);
    voxelise_by(source, a, [file](sparse_grid& grid) { fill_from_mesh(grid, file->mesh); });
}

}  // namespace

height_range voxel_source::heights() const {
    height_range r{.bottom = 0, .top = 0, .up = up_direction};
    for (int a = 0; a < 3; ++a) {
        r.bottom += std::min(up_direction[a] * bounds.lo[a], up_direction[a] * bounds.hi[a]);
        r.top += std::max(up_direction[a] * bounds.lo[a], up_direction[a] * bounds.hi[a]);
    }
    return r;
}

voxel_source load_voxels(voxel_arguments const& a) {
    voxel_source source;
    source.up = axis_of(a.up);
    source.up_direction = up_rotation::of(source.up).direction_to_user({0, 0, 1});
    source.repaired = {{"turned_faces", 0}, {"holes", 0}, {"open_edges", 0}, {"filled_by_winding_number", 0}};
    std::string const kind = extension_of(a.input);
    source.border = !a.border.empty() ? a.border : kind == "asc" || a.input.rfind("builtin:cliff", 0) == 0 ? "extend" : "ground";
    if (a.input.rfind("builtin:", 0) == 0 && a.input.rfind("builtin:outcrop", 0) != 0) {
        load_builtin(source, a);
    } else if (kind == "asc") {
        load_terrain(source, a);
    } else if (kind == "png" || kind == "pgm") {
        load_image(source, a, kind == "png");
    } else if (kind == "nrrd") {
        load_volume(source, a);
    } else if (kind == "vox") {
        load_vox(source, a);
    } else if (a.input.rfind("builtin:", 0) == 0) {
        rock_input rock = load_rock(a.input, a.seed);
        load_solid(source, a, std::move(rock.body));
    } else {
        load_mesh(source, a);
    }
    return source;
}

}  // namespace weather
