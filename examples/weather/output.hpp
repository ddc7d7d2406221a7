// Files of a run: meshes in every format asked for, time series, text.
#pragma once

#include "surface.hpp"

#include <tafoni/io/write_pvd.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace weather {

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
    [[nodiscard]] std::string read_text(std::string const& name) const;  ///< empty where there is none

private:
    std::filesystem::path folder_;
    std::vector<std::string> formats_;
    tafoni::vec3 origin_;
};

}  // namespace weather
