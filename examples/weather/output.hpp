// Files of a run: meshes in every format asked for, time series, text.
#pragma once

#include "surface.hpp"

#include <tafoni/io/write_pvd.hpp>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace weather {

/// Makes the folder and those above it. \throws tafoni::io_error
std::filesystem::path made_folder(std::string const& name);

/// Looks whether `made_folder` will be able to, and makes nothing. \throws tafoni::io_error
void require_makable(std::string const& name);

/// `prefix` and the number with at least so many digits.
std::string numbered_name(char const* prefix, std::uint64_t n, int digits);

class output_folder {
public:
    /// \param formats  of obj, ply, stl, vtp.  \param origin  what float formats are relative to.
    output_folder(std::filesystem::path folder, std::vector<std::string> formats, tafoni::vec3 const& origin)
        : folder_(std::move(folder)), formats_(std::move(formats)), origin_(origin) {}

    [[nodiscard]] std::filesystem::path const& folder() const { return folder_; }
    [[nodiscard]] bool writes(std::string const& format) const;
    /// DIR/name.EXT in every format, atomically. \throws tafoni::io_error
    void write(std::string const& name, surface_mesh const& surface) const;
    void write_text(std::string const& name, std::string const& text) const;
    /// Removes what an older run of `process` left and this one may not overwrite: its results, and its snapshots
    /// that `keep` does not want. Files of other names stay. \throws tafoni::io_error
    void remove_old(std::string const& process, std::function<bool(std::uint64_t)> const& keep) const;
    [[nodiscard]] std::string read_text(std::string const& name) const;  ///< empty where there is none

private:
    std::filesystem::path folder_;
    std::vector<std::string> formats_;
    tafoni::vec3 origin_;
};

}  // namespace weather
