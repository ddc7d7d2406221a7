#include <catch2/catch.hpp>

#include <tafoni/io/detail/write_file.hpp>
#include <tafoni/io/vtk_xml.hpp>

#include "file_testing.hpp"

#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <csignal>

using namespace tafoni;
using tafoni_test::bytes_of;
using tafoni_test::failure;
using tafoni_test::failure_of;

namespace {

void write(std::filesystem::path const& path, std::string_view bytes) { detail::write_file("test", path, bytes); }
failure refused(std::filesystem::path const& path, std::string_view bytes = "new") {
    return failure_of([&] {
        write(path, bytes);
        return 0;
    });
}

/// The exit code of `f` in a process of its own; 256 and more when a signal ended it.
template <class F>
int in_child(F&& f) {
    pid_t const child = ::fork();
    if (child == 0) ::_exit(f());
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 256 + WTERMSIG(status);
}

}  // namespace

TEST_CASE("a file is created or replaced, and nothing else is left in its folder") {
    tafoni_test::scratch_folder const folder;
    write(folder / "a", "one");
    CHECK(bytes_of(folder / "a") == "one");
    write(folder / "a", "");
    CHECK(bytes_of(folder / "a").empty());
    std::string const large(3000000, 'x');
    write(folder / "a", large);
    CHECK(bytes_of(folder / "a") == large);
    CHECK(folder.entries() == 1);
}

TEST_CASE("permissions of a file that is replaced are kept, a new one gets those of the process") {
    tafoni_test::scratch_folder const folder;
    mode_t const before = ::umask(027);
    write(folder / "new", "x");
    ::umask(before);
    struct stat status {};
    REQUIRE(::stat((folder / "new").c_str(), &status) == 0);
    CHECK((status.st_mode & 0777) == 0640);
    REQUIRE(::chmod((folder / "new").c_str(), 0604) == 0);
    write(folder / "new", "y");
    REQUIRE(::stat((folder / "new").c_str(), &status) == 0);
    CHECK((status.st_mode & 0777) == 0604);
}

TEST_CASE("a link keeps pointing to the file that is replaced, also one whose target is new") {
    tafoni_test::scratch_folder const folder;
    write(folder / "target", "old");
    std::filesystem::create_symlink("target", folder / "link");
    write(folder / "link", "new");
    CHECK(std::filesystem::is_symlink(folder / "link"));
    CHECK(bytes_of(folder / "target") == "new");
    std::filesystem::create_symlink("later", folder / "early");
    write(folder / "early", "there");
    CHECK(bytes_of(folder / "later") == "there");
    std::filesystem::create_symlink("loop", folder / "loop");
    CHECK(refused(folder / "loop").code == errc::write_failed);
}

TEST_CASE("a reader that has the old file open goes on reading the old bytes") {
    tafoni_test::scratch_folder const folder;
    write(folder / "a", "old bytes");
    std::ifstream reader(folder / "a");
    write(folder / "a", "new");
    std::string word;
    std::getline(reader, word);
    CHECK(word == "old bytes");
}

TEST_CASE("a full device, a directory, a pipe and a missing folder are refused") {
    tafoni_test::scratch_folder const folder;
    if (std::filesystem::exists("/dev/full")) {
        failure const full = refused("/dev/full");
        CHECK(full.code == errc::write_failed);
        CHECK(tafoni_test::contains(full.what, "No space"));
        CHECK(std::filesystem::is_character_file("/dev/full"));
    }
    CHECK(refused(folder / ".").code == errc::not_a_file);
    REQUIRE(::mkfifo((folder / "pipe").c_str(), 0600) == 0);
    CHECK(refused(folder / "pipe").code == errc::not_a_file);
    CHECK(refused(folder / "none" / "a").code == errc::write_failed);
    CHECK(refused(folder / std::string(4096, 'x')).code == errc::write_failed);
    CHECK_FALSE(refused("/dev/null").happened);
    CHECK(std::filesystem::is_character_file("/dev/null"));
}

TEST_CASE("beyond the limit on file sizes the write fails, the old file stays and the process lives") {
    tafoni_test::scratch_folder const folder;
    write(folder / "a", "old");
    int const code = in_child([&] {
        rlimit const limit{1000, 1000};
        ::setrlimit(RLIMIT_FSIZE, &limit);
        return refused(folder / "a", std::string(100000, 'x')).code == errc::write_failed ? 0 : 1;
    });
    CHECK(code == 0);
    CHECK(bytes_of(folder / "a") == "old");
    CHECK(folder.entries() == 1);
}

TEST_CASE("in a folder or over a file without permission the write fails and the old file stays") {
    tafoni_test::scratch_folder const folder;
    std::filesystem::create_directory(folder / "inner");
    write(folder / "inner" / "a", "old");
    write(folder / "mine", "old");
    REQUIRE(::chmod((folder / "inner").c_str(), 0555) == 0);
    REQUIRE(::chmod((folder / "mine").c_str(), 0444) == 0);
    int const code = in_child([&] {
        if (::geteuid() == 0 && ::setuid(65534) != 0) return 2;
        bool const kept = refused(folder / "inner" / "a").code == errc::write_failed &&
                          refused(folder / "inner" / "b").code == errc::write_failed &&
                          refused(folder / "mine").code == errc::write_failed;
        return kept ? 0 : 1;
    });
    CHECK(code == 0);
    CHECK(bytes_of(folder / "inner" / "a") == "old");
    CHECK(bytes_of(folder / "mine") == "old");
    REQUIRE(::chmod((folder / "inner").c_str(), 0755) == 0);
}

TEST_CASE("a process killed while it writes leaves the old or the new file whole, a hundred times of a hundred") {
    tafoni_test::scratch_folder const folder;
    std::string const one(400000, '1');
    std::string const two(300000, '2');
    write(folder / "a", one);
    stream random(1, stage::user, 0);
    int whole = 0;
    for (int trial = 0; trial < 100; ++trial) {
        pid_t const child = ::fork();
        if (child == 0) {
            for (;;) {
                write(folder / "a", two);
                write(folder / "a", one);
            }
        }
        ::usleep(static_cast<useconds_t>(random.index_below(8000)));
        ::kill(child, SIGKILL);
        ::waitpid(child, nullptr, 0);
        std::string const found = bytes_of(folder / "a");
        if (found == one || found == two) ++whole;
    }
    CHECK(whole == 100);
}

TEST_CASE("a mesh that is refused leaves the old file as it was") {
    tafoni_test::scratch_folder const folder;
    indexed_mesh mesh;
    mesh.add_vertex({0, 0, std::numeric_limits<double>::quiet_NaN()});
    write(folder / "a.vtp", "old");
    CHECK(failure_of([&] {
              write_vtp(folder / "a.vtp", mesh);
              return 0;
          }).code == errc::non_finite_vertex);
    CHECK(bytes_of(folder / "a.vtp") == "old");
}
