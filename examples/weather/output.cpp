#include "output.hpp"

#include "input.hpp"

#include <tafoni/io/write_obj.hpp>
#include <tafoni/io/write_ply.hpp>
#include <tafoni/io/write_stl.hpp>
#include <tafoni/io/write_vtp.hpp>

#include <algorithm>

namespace weather {

bool output_folder::writes(std::string const& format) const {
    return std::find(formats_.begin(), formats_.end(), format) != formats_.end();
}

void output_folder::write(std::string const& name, surface_mesh const& surface) const {
    auto const path = [&](char const* extension) { return folder_ / (name + extension); };
    if (writes("obj")) {
        // OBJ has no face channels; groups by fresh or original skin would split smoothing, so none is written.
        tafoni::write_obj(path(".obj"), surface.mesh);
    }
    if (writes("ply")) tafoni::write_ply(path(".ply"), surface.mesh, surface.attributes);
    if (writes("stl")) tafoni::write_stl(path(".stl"), surface.mesh, {}, {.origin = origin_});
    if (writes("vtp")) tafoni::write_vtp(path(".vtp"), surface.mesh, surface.attributes);
}

void output_folder::write_text(std::string const& name, std::string const& text) const {
    tafoni::detail::write_file("weather", folder_ / name, text);
}

std::string output_folder::read_text(std::string const& name) const {
    std::error_code ignored;
    if (!std::filesystem::exists(folder_ / name, ignored)) return {};
    return load_bytes((folder_ / name).string());
}

}  // namespace weather
