#include "notes.hpp"

#include <tafoni/geometry/self_intersections.hpp>

#include <algorithm>
#include <cstdio>

namespace weather {

using namespace tafoni;

void note(std::string const& text) { std::fprintf(stderr, "weather: note: %s\n", text.c_str()); }

void unused_options::tell(char const* why, std::initializer_list<std::pair<char const*, bool>> options) {
    for (auto const& [name, given] : options) {
        if (!given) continue;
        note(std::string(name) + " has no effect " + why);
        names_.push_back(name);
    }
}

cut_counts cut_counts::of(triangle_surface const& before, triangle_surface const& after) {
    if (std::max(before.triangles.size(), after.triangles.size()) > most_faces) return {};
    return {.before = self_intersections(before.positions, before.triangles).size(),
            .after = self_intersections(after.positions, after.triangles).size(),
            .counted = true};
}

void cut_counts::tell(std::string const& remedy) const {
    if (!counted) {
        note("whether triangles cut each other was not looked at: there are more than " + std::to_string(most_faces));
    } else if (after > before) {
        note(std::to_string(after) + " pairs of triangles cut each other" + (before > 0 ? ", " + std::to_string(before) + " in INPUT" : "") +
             "; " + remedy);
    }
}

nlohmann::ordered_json cut_counts::json() const {
    if (!counted) return nullptr;
    return {{"before", before}, {"after", after}};
}

}  // namespace weather
