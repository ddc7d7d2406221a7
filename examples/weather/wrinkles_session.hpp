// One run of `weather wrinkles`, from the input to the report.
#pragma once

#include "mesh_output.hpp"
#include "progress.hpp"
#include "wrinkles_command.hpp"

#include <tafoni/core/thread_pool.hpp>
#include <tafoni/weathering/wrinkles.hpp>

#include <nlohmann/json.hpp>

#include <vector>

namespace weather {

class wrinkles_session {
public:
    explicit wrinkles_session(wrinkles_arguments const& a);
    /// False when Ctrl-C ended it early.
    bool run();

private:
    [[nodiscard]] std::vector<tafoni::wrinkle> wrinkles(mesh_input const& input) const;
    [[nodiscard]] std::vector<tafoni::enlargement> enlargements() const;
    [[nodiscard]] surface_mesh worn(tafoni::wrinkle_pattern const& pattern, tafoni::triangle_surface const& base, std::uint32_t times);
    void write_report(mesh_input const& input, tafoni::wrinkle_pattern const& pattern, double volume) const;

    wrinkles_arguments a_;
    progress progress_;
    tafoni::thread_pool threads_;
    output_folder out_;
    nlohmann::ordered_json seconds_;
    bool stopped_ = false;
};

}  // namespace weather
