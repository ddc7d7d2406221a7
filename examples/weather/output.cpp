#include "output.hpp"

#include "input.hpp"

#include <tafoni/io/write_obj.hpp>
#include <tafoni/io/write_ply.hpp>
#include <tafoni/io/write_stl.hpp>
#include <tafoni/io/write_vtp.hpp>

#include <tafoni/core/error.hpp>

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdio>

namespace weather {

namespace {

[[noreturn]] void refuse(std::filesystem::path const& path, char const* why) {
    tafoni::detail::fail<tafoni::io_error>(tafoni::errc::write_failed, path.string() + ": " + why,
                                           {.kind = tafoni::entity::file, .file = path.string()});
}

/// The number in PREFIX + `digits` digits or more + .obj, .ply, .stl or .vtp; false for any other name.
bool is_numbered(std::string const& name, std::string const& prefix, std::size_t digits, std::uint64_t& number) {
    std::size_t const dot = name.rfind('.');
    if (dot == std::string::npos || name.compare(0, prefix.size(), prefix) != 0 || dot < prefix.size() + digits) return false;
    std::string const e = name.substr(dot + 1);
    if (e != "obj" && e != "ply" && e != "stl" && e != "vtp") return false;
    auto const r = std::from_chars(name.data() + prefix.size(), name.data() + dot, number);
    return r.ec == std::errc{} && r.ptr == name.data() + dot;
}

}  // namespace

std::string numbered_name(char const* prefix, std::uint64_t n, int digits) {
    char text[64];
    std::snprintf(text, sizeof text, "%s%0*llu", prefix, digits, static_cast<unsigned long long>(n));
    return text;
}

std::filesystem::path made_folder(std::string const& name) {
    std::error_code error;
    std::filesystem::create_directories(name, error);
    if (error || !std::filesystem::is_directory(name)) refuse(name, "cannot be made a folder");
    return name;
}

void require_makable(std::string const& name) {
    std::error_code error;
    std::filesystem::path at = std::filesystem::absolute(name, error).lexically_normal();
    while (!error && at.has_relative_path() && !std::filesystem::exists(at, error)) at = at.parent_path();
    if (error || !std::filesystem::is_directory(at)) refuse(name, "cannot be made a folder");
    if (::access(at.c_str(), W_OK | X_OK) != 0) refuse(at, "cannot be written to");
}

void output_folder::remove_old(std::string const& process, std::function<bool(std::uint64_t)> const& keep) const {
    std::vector<std::filesystem::path> old;
    auto const collect = [&old](std::filesystem::path const& folder, auto const& is_old) {
        std::error_code error;
        for (auto const& entry : std::filesystem::directory_iterator(folder, error)) {
            if (entry.is_regular_file() && is_old(entry.path().filename().string())) old.push_back(entry.path());
        }
    };
    std::uint64_t n = 0;
    collect(folder_, [](std::string const& name) {
        for (char const* const stem : {"weathered.", "blocks."}) {
            for (char const* const e : {"obj", "ply", "stl", "vtp"}) {
                if (name == std::string(stem) + e) return true;
            }
        }
        return name == "links.vtp" || name == "bonds.vtp" || name == "paths.vtp" || name == "water.vtp" || name == "report.json";
    });
    collect(folder_ / "snapshots", [&](std::string const& name) {
        return name == process + ".pvd" || (is_numbered(name, process + "_", 8, n) && !keep(n));
    });
    collect(folder_ / "blocks", [&](std::string const& name) { return is_numbered(name, "block_", 6, n); });
    for (auto const& path : old) {
        std::error_code error;
        if (!std::filesystem::remove(path, error)) refuse(path, "cannot be removed");
    }
}

bool output_folder::writes(std::string const& format) const {
    return std::find(formats_.begin(), formats_.end(), format) != formats_.end();
}

void output_folder::write(std::string const& name, surface_mesh const& surface) const {
    auto const path = [&](char const* extension) { return folder_ / (name + extension); };
    if (writes("obj")) {
        // OBJ has no face channels; groups by fresh or original skin would split smoothing, so only materials are.
        tafoni::write_obj(path(".obj"), surface.mesh, {.groups = surface.attributes.groups});
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
