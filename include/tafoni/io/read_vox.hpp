/// \file
/// Reads the voxels of MagicaVoxel files (.vox).
#ifndef TAFONI_IO_READ_VOX_HPP
#define TAFONI_IO_READ_VOX_HPP

#include <tafoni/io/detail/load_file.hpp>
#include <tafoni/io/detail/load_little.hpp>
#include <tafoni/io/detail/source_text.hpp>
#include <tafoni/io/vox_file.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace tafoni {
namespace detail {

class vox_parser {
public:
    explicit vox_parser(source_text const& source) : source_(source), at_(source.begin()), end_(source.end()) {
        source.require_plain();
    }

    vox_file parse() {
        if (source_.bytes.substr(0, 4) != std::string_view("VOX ").substr(0, source_.bytes.size())) {
            source_.fail_at_byte(at_, errc::wrong_format, "expected 'VOX '");
        }
        require(8, "the magic and the version");
        out_.version = load_little<std::uint32_t>(at_ + 4);
        if (out_.version != 150 && out_.version != 200) {
            source_.fail_at_byte(at_ + 4, errc::unsupported,
                                 "expected version 150 or 200, got " + std::to_string(out_.version));
        }
        at_ += 8;
        chunk const main = open_chunk(end_);
        if (main.id != "MAIN") source_.fail_at_byte(main.start, errc::bad_syntax, "expected the chunk MAIN, got " + main.text());
        if (main.next != end_) {
            source_.fail_at_byte(main.next, errc::bad_count, "expected the end of the file behind the chunk MAIN");
        }
        char const* announced_at = nullptr;
        std::uint32_t announced = 0;
        bool sized = false;
        for (at_ = main.children; at_ != end_;) {
            chunk const c = open_chunk(end_);
            if (sized && c.id != "XYZI") {
                source_.fail_at_byte(c.start, errc::bad_syntax, "expected the chunk XYZI behind SIZE, got " + c.text());
            }
            if (c.id == "PACK") {
                require_content(c, 4);
                announced_at = c.content;
                announced = load_little<std::uint32_t>(c.content);
            } else if (c.id == "SIZE") {
                read_size(c);
                sized = true;
            } else if (c.id == "XYZI") {
                if (!sized) source_.fail_at_byte(c.start, errc::bad_syntax, "expected the chunk SIZE before XYZI");
                read_voxels(c);
                sized = false;
            }
            at_ = c.next;
        }
        if (sized) source_.fail_at_byte(end_, errc::truncated, "expected the chunk XYZI behind SIZE, got end of file");
        if (out_.models.empty()) source_.fail_at_byte(end_, errc::empty_input, "the file holds no model");
        if (announced_at != nullptr && announced != out_.models.size()) {
            source_.fail_at_byte(announced_at, errc::bad_count,
                                 "expected " + std::to_string(announced) + " models, got " +
                                     std::to_string(out_.models.size()));
        }
        return std::move(out_);
    }

private:
    struct chunk {
        char const* start = nullptr;
        std::string_view id{};
        char const* content = nullptr;
        char const* children = nullptr;
        char const* next = nullptr;
        [[nodiscard]] std::string text() const {
            std::string r = "'";
            for (char const c : id) r += c >= ' ' && c <= '~' ? c : '?';
            return r + "'";
        }
    };

    void require(std::uint64_t bytes, char const* what) const {
        if (bytes <= static_cast<std::uint64_t>(end_ - at_)) return;
        source_.fail_at_byte(end_, errc::truncated, "expected " + std::to_string(bytes) + " bytes of " + what + ", got " +
                                                        std::to_string(end_ - at_));
    }

    chunk open_chunk(char const* limit) {
        require(12, "a chunk's header");
        chunk c{.start = at_, .id = {at_, 4}, .content = at_ + 12};
        std::uint64_t const content = load_little<std::uint32_t>(at_ + 4);
        std::uint64_t const children = load_little<std::uint32_t>(at_ + 8);
        auto const left = static_cast<std::uint64_t>(limit - c.content);
        if (content + children > left) {
            source_.fail_at_byte(at_ + 4, errc::truncated,
                                 "expected " + std::to_string(content + children) + " bytes in the chunk " + c.text() +
                                     ", got " + std::to_string(left));
        }
        c.children = c.content + content;
        c.next = c.children + children;
        return c;
    }

    void require_content(chunk const& c, std::uint64_t bytes) const {
        auto const got = static_cast<std::uint64_t>(c.children - c.content);
        if (got == bytes) return;
        source_.fail_at_byte(c.start + 4, got < bytes ? errc::truncated : errc::bad_count,
                             "expected " + std::to_string(bytes) + " bytes in the chunk " + c.text() + ", got " +
                                 std::to_string(got));
    }

    void read_size(chunk const& c) {
        require_content(c, 12);
        vox_model model;
        for (std::size_t d = 0; d < 3; ++d) {
            std::uint32_t const n = load_little<std::uint32_t>(c.content + 4 * d);
            if (n == 0 || n > 256) {
                source_.fail_at_byte(c.content + 4 * d, errc::bad_count,
                                     "expected a size of 1 to 256, got " + std::to_string(n),
                                     {.value = static_cast<double>(n), .limit = n == 0 ? 1.0 : 256.0});
            }
            model.size[d] = n;
        }
        size_ = model.size;
    }

    void read_voxels(chunk const& c) {
        if (c.children - c.content < 4) require_content(c, 4);
        std::uint64_t const count = load_little<std::uint32_t>(c.content);
        require_content(c, 4 + 4 * count);
        vox_model model{.size = size_};
        model.voxels.reserve(count);
        char const* at = c.content + 4;
        for (std::uint64_t v = 0; v < count; ++v, at += 4) {
            auto const byte = [at](std::size_t k) { return static_cast<std::uint8_t>(at[k]); };
            for (std::size_t d = 0; d < 3; ++d) {
                if (byte(d) < size_[d]) continue;
                source_.fail_at_byte(at + d, errc::out_of_range,
                                     "voxel " + std::to_string(v) + " lies at " + "xyz"[d] + " = " +
                                         std::to_string(byte(d)) + ", the size is " + std::to_string(size_[d]),
                                     {.value = static_cast<double>(byte(d)), .limit = static_cast<double>(size_[d] - 1)});
            }
            model.voxels.push_back({byte(0), byte(1), byte(2), byte(3)});
        }
        out_.models.push_back(std::move(model));
    }

    source_text const& source_;
    char const* at_;
    char const* end_;
    std::array<std::size_t, 3> size_{};
    vox_file out_{};
};

}  // namespace detail

/// Reads a MagicaVoxel file, version 150 or 200, from memory; `name` stands in for the path in errors. O(bytes).
///
/// Every pair of chunks SIZE and XYZI becomes a model, in the order of the file and in its own coordinates
/// (z up): where a scene puts them, palette, materials, layers and cameras are passed over. Colours are
/// indices, so that materials can be told apart.
/// \throws io_error  naming the byte: `wrong_format`, `unsupported`, `bad_syntax`, `bad_count`, `out_of_range`,
///                   `truncated`, `empty_input`.
[[nodiscard]] inline vox_file read_vox(std::string_view bytes, std::string_view name) {
    detail::source_text const source{"read_vox", bytes, name};
    return detail::vox_parser(source).parse();
}

/// Reads a MagicaVoxel file. \throws io_error  as above, and `cannot_open`, `not_a_file`.
[[nodiscard]] inline vox_file read_vox(std::filesystem::path const& path) {
    detail::loaded_file const file = detail::load_file("read_vox", path);
    return read_vox(file.bytes(), path.string());
}

}  // namespace tafoni

#endif
