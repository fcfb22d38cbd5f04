#include "tools/lineshaft/gnuplot.hpp"

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace lineshaft {

namespace {

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

/// A file without a name that holds `text`, to be read from its beginning.
File holding(const std::string& text) {
    File file(std::tmpfile(), &std::fclose);
    if (!file || std::fwrite(text.data(), 1, text.size(), file.get()) != text.size() ||
        std::fflush(file.get()) != 0)
        return {nullptr, &std::fclose};
    std::rewind(file.get());
    return file;
}

/// Starts gnuplot between two files; 0 or errno.
int start(std::FILE* input, std::FILE* output, pid_t& process) {
    std::array<char, 8> name{"gnuplot"};
    std::array<char*, 2> arguments{name.data(), nullptr};
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ::fileno(input), STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, ::fileno(output), STDOUT_FILENO);
    const int error =
        ::posix_spawnp(&process, name.data(), &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    return error;
}

std::string read_all(std::FILE* file) {
    std::rewind(file);
    std::string bytes;
    std::array<char, 65536> part;
    while (const std::size_t count = std::fread(part.data(), 1, part.size(), file))
        bytes.append(part.data(), count);
    return bytes;
}

}  // namespace

Picture run_gnuplot(const std::string& script) {
    const File input = holding(script), output = holding("");
    if (!input || !output)
        return {{}, fmt::format("cannot write a temporary file: {}", std::strerror(errno))};
    pid_t process = 0;
    if (const int error = start(input.get(), output.get(), process); error == ENOENT)
        return {{}, "gnuplot is not installed; Debian has it in the package gnuplot-nox"};
    else if (error != 0)
        return {{}, fmt::format("cannot start gnuplot: {}", std::strerror(error))};
    int status = 0;
    while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
    }
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        return {{}, "gnuplot gave up, see its message above"};
    Picture picture{read_all(output.get()), {}};
    if (picture.bytes.empty()) picture.error = "gnuplot drew nothing";
    return picture;
}

std::string gnuplot_text(std::string text) {
    for (std::size_t at = 0; at < text.size(); ++at) {
        if (static_cast<unsigned char>(text[at]) < ' ') text[at] = ' ';
        if (text[at] == '\'') text.insert(at++, 1, '\'');
    }
    return "'" + text + "'";
}

}  // namespace lineshaft
