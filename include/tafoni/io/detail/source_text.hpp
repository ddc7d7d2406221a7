/// \file
/// The bytes of a file with its name, and errors that point into them.
#ifndef TAFONI_IO_DETAIL_SOURCE_TEXT_HPP
#define TAFONI_IO_DETAIL_SOURCE_TEXT_HPP

#include <tafoni/core/error.hpp>

#include <algorithm>
#include <string>
#include <string_view>

namespace tafoni::detail {

[[nodiscard]] inline bool is_blank(char c) noexcept { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
[[nodiscard]] inline bool is_line_end(char c) noexcept { return c == '\n' || c == '\r'; }
[[nodiscard]] inline bool is_space(char c) noexcept { return is_blank(c) || is_line_end(c); }

/// What a reader reads. Lines are counted only when an error needs them.
struct source_text {
    char const* who;         ///< the reader's name, for messages
    std::string_view bytes;
    std::string_view name;   ///< path as given by the user

    [[nodiscard]] char const* begin() const noexcept { return bytes.data(); }
    [[nodiscard]] char const* end() const noexcept { return bytes.data() + bytes.size(); }

    /// The token at `at`, in quotes, cut to 32 characters, with unprintable bytes shown as `?`.
    [[nodiscard]] std::string token(char const* at) const {
        if (at == end()) return "end of file";
        if (is_line_end(*at)) return "end of line";
        std::string text = "'";
        char const* stop = at;
        while (stop != end() && !is_space(*stop) && stop - at < 32) ++stop;
        for (; at != stop; ++at) text += *at >= ' ' && *at <= '~' ? *at : '?';
        return text + "'";
    }

    /// Fails at a place in a text file: "who: file:line:column: message".
    template <class Error = io_error>
    [[noreturn]] void fail_at(char const* at, errc code, std::string const& message, error_place place = {}) const {
        std::uint64_t line = 1;
        char const* start = begin();
        for (char const* c = begin(); c != at; ++c) {
            if (*c == '\n' || (*c == '\r' && (c + 1 == end() || c[1] != '\n'))) {
                ++line;
                start = c + 1;
            }
        }
        place.file = std::string(name);
        place.line = line;
        place.column = static_cast<std::uint64_t>(at - start) + 1;
        if (place.kind == entity::none) place.kind = entity::file;
        std::string const text = std::string(who) + ": " + place.file + ":" + std::to_string(line) + ":" +
                                 std::to_string(place.column) + ": " + message;
        fail<Error>(code, text, std::move(place));
    }

    /// Fails at a place in a binary file: "who: file: byte N: message".
    [[noreturn]] void fail_at_byte(char const* at, errc code, std::string const& message,
                                   error_place place = {}) const {
        place.file = std::string(name);
        if (place.kind == entity::none) place.kind = entity::file;
        if (place.index == error_place::nowhere) place.index = static_cast<std::uint64_t>(at - begin());
        std::string const text =
            std::string(who) + ": " + place.file + ": byte " + std::to_string(at - begin()) + ": " + message;
        fail<io_error>(code, text, std::move(place));
    }

    /// Refuses what can be none of our formats, by its first bytes: empty, compressed, UTF-16.
    void require_plain() const {
        auto const starts = [&](std::string_view magic) { return bytes.substr(0, magic.size()) == magic; };
        auto const refuse = [&](errc code, char const* what) { fail_at_byte(begin(), code, what); };
        if (bytes.empty()) refuse(errc::empty_input, "the file is empty");
        if (starts("\x1f\x8b")) refuse(errc::wrong_format, "this is gzip-compressed data; unpack it first");
        if (starts("PK\x03\x04") || starts("PK\x05\x06")) refuse(errc::wrong_format, "this is a zip archive; unpack it first");
        if (starts("BZh")) refuse(errc::wrong_format, "this is bzip2-compressed data; unpack it first");
        if (starts("\xfd" "7zXZ")) refuse(errc::wrong_format, "this is xz-compressed data; unpack it first");
        if (starts("\x28\xb5\x2f\xfd")) refuse(errc::wrong_format, "this is zstd-compressed data; unpack it first");
        if (starts("7z\xbc\xaf")) refuse(errc::wrong_format, "this is a 7z archive; unpack it first");
    }

    /// As `require_plain`, for formats that are text from the first byte. Returns where the text
    /// starts, behind a byte order mark of UTF-8.
    [[nodiscard]] char const* require_text() const {
        require_plain();
        auto const starts = [&](std::string_view magic) { return bytes.substr(0, magic.size()) == magic; };
        if (starts("\xff\xfe") || starts("\xfe\xff")) {
            fail_at_byte(begin(), errc::wrong_format, "this is UTF-16 text; expected ASCII or UTF-8");
        }
        return begin() + (starts("\xef\xbb\xbf") ? 3 : 0);
    }
};

}  // namespace tafoni::detail

#endif
