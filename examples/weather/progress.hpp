// Progress on stderr, and Ctrl-C as a request to stop.
#pragma once

#include <tafoni/core/run_context.hpp>

#include <chrono>
#include <string>
#include <string_view>

namespace weather {

enum class progress_style { none, bar, json };

/// Of `bar`, `json`, `none`; `auto` is a bar on a terminal.
[[nodiscard]] progress_style progress_style_of(std::string const& name);

class stopwatch {
public:
    /// Seconds since it was made or asked last.
    double lap() {
        auto const now = std::chrono::steady_clock::now();
        double const s = std::chrono::duration<double>(now - start_).count();
        start_ = now;
        return s;
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// From now on Ctrl-C only sets a mark; a second one ends the program at once.
void catch_interrupt();
[[nodiscard]] bool interrupted();

/// Shows stages, or nothing, and asks to stop once the user has pressed Ctrl-C.
class progress {
public:
    explicit progress(progress_style style) : style_(style) {}
    progress(progress const&) = delete;
    progress& operator=(progress const&) = delete;
    ~progress();

    tafoni::step_control show(std::string_view stage, double fraction, std::string const& note = {});
    /// For library calls that take a context.
    [[nodiscard]] tafoni::run_context context();

private:
    progress_style style_;
    std::string last_line_;
    std::string last_stage_{};
    int last_percentage_ = -1;
    bool open_line_ = false;
};

}  // namespace weather
