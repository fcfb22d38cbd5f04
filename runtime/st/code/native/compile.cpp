#include "runtime/st/code/native/compile.hpp"

#include <atomic>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <optional>
#include <sstream>
#include <thread>
#include <utility>
#include <vector>

#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "runtime/source/input_file.hpp"
#include "runtime/st/code/native/cache.hpp"
#include "runtime/st/code/native/emit.hpp"
#include "runtime/st/code/native/self_test.hpp"
#include "runtime/st/code/native/stencil.hpp"

namespace lineshaft::st {

#ifdef LINESHAFT_NATIVE

namespace {

using namespace std::chrono_literals;

/// As the program itself is compiled. -O2 of gcc 12.2 loses the rounding of REAL in words that
/// stand side by side, in its vectoriser.
constexpr const char* flags[] = {"-std=c++20",
                                 "-O2",
                                 "-shared",
                                 "-fPIC",
                                 "-nostdlib",
                                 "-pipe",
                                 "-w",
                                 "-ffp-contract=off",
                                 "-fno-math-errno",
                                 "-fno-tree-vectorize",
                                 "-fno-tree-slp-vectorize",
                                 "-ftrapping-math",
                                 "-fno-strict-aliasing",
                                 "-fno-exceptions",
                                 "-fno-rtti",
                                 "-fno-stack-protector",
                                 "-fno-asynchronous-unwind-tables",
                                 "-fvisibility=hidden"};

struct Compiler {
    std::vector<std::string> words;  ///< of a command line
    std::string identity;            ///< another one after an update
};

std::string found_in_path(const std::string& name) {
    if (name.find('/') != std::string::npos) return name;
    const char* path = std::getenv("PATH");
    std::istringstream folders(path ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');) {
        const std::string file = folder + "/" + name;
        if (!folder.empty() && ::access(file.c_str(), X_OK) == 0) return file;
    }
    return {};
}

/// Another one after an update; empty where there is no such file.
std::string version_of(const std::string& file) {
    struct stat status {};
    if (::stat(file.c_str(), &status) != 0) return {};
    std::error_code same;
    return fmt::format("{} {} {}.{}", std::filesystem::canonical(file, same).string(),
                       status.st_size, status.st_mtim.tv_sec, status.st_mtim.tv_nsec);
}

Compiler find_compiler() {
    Compiler found;
    const char* named = std::getenv("CXX");
    std::istringstream words(named ? named : "");
    for (std::string word; words >> word;) found.words.push_back(word);
    std::string file;
    if (found.words.empty()) {
        for (const char* name : {"c++", "g++", "clang++"})
            if (file.empty()) file = found_in_path(name);
        if (file.empty()) throw NoCompiledCode("there is no c++, g++ or clang++ in PATH");
        found.words.push_back(file);
    } else {
        file = found_in_path(found.words[0]);
    }
    const std::string version = version_of(file);
    if (version.empty())
        throw NoCompiledCode(fmt::format("there is no compiler '{}' (CXX)", named));
    found.identity = fmt::format("{} {}", fmt::join(found.words, " "), version);
    return found;
}

std::vector<std::string_view> external_names() {
    std::vector<std::string_view> names(stencil_external_names,
                                        stencil_external_names + stencil_externals_count);
    names.push_back("native_call_block");
    return names;
}

const NativeEntry* begin(void* library) {
    static const std::vector<const void*> externals = [] {
        std::vector<const void*> made(stencil_externals,
                                      stencil_externals + stencil_externals_count);
        made.push_back(reinterpret_cast<const void*>(&native_call_block));
        return made;
    }();
    using Begin = const NativeEntry* (*)(const void* const*, const double*, const std::uint64_t*);
    const auto take = reinterpret_cast<Begin>(::dlsym(library, "native_begin"));
    const NativeEntry* entries =
        take ? take(externals.data(), meaning::tested_reals, meaning::tested_words) : nullptr;
    if (!entries) throw NoCompiledCode("what the compiler makes has other results");
    return entries;
}

class Compiling {
  public:
    explicit Compiling(void (*tell)(const std::string&)) : tell_(tell) {}

    void ask(const Code& code, const std::shared_ptr<Native>& native) {
        try {
            if (!code.points.empty()) return;
            const std::lock_guard lock(mutex_);
            if (is_given_up_) return;
            if (!cache_) begin_working();
            const std::string key = emission_key(code) + compiler_.identity;
            const auto [made, is_new] = made_.try_emplace(key);
            Made& it = made->second;
            if (is_new)
                if (void* library = cache_->load(key)) it.entries = begin(library);
            if (it.entries) return give(*native, it.entries);
            is_ending_ = false;
            it.waiting.push_back(native);
            if (!is_new) return;
            jobs_.push_back({key, emitted(code, names_)});
            if (!std::exchange(is_busy_, true)) std::thread([this] { work(); }).detach();
        } catch (const NoCompiledCode& why) {
            give_up(why.what());
        }
    }

    std::size_t end() {
        std::unique_lock lock(mutex_);
        is_ending_ = true;
        while (is_busy_ && !interrupt_requested) idle_.wait_for(lock, 20ms);
        if (is_busy_ && process_ > 0) ::kill(process_, SIGTERM);
        return given_;
    }

  private:
    struct Made {
        const NativeEntry* entries = nullptr;
        std::vector<std::shared_ptr<Native>> waiting;
    };
    struct Job {
        std::string key, text;
    };

    void begin_working() {
        compiler_ = find_compiler();
        for (const char* flag : flags) compiler_.identity += flag;
        const std::string writer = version_of("/proc/self/exe");
        if (writer.empty()) throw NoCompiledCode("/proc/self/exe is not there");
        compiler_.identity += writer;
        cache_.emplace();
    }

    void give(Native& native, const NativeEntry* entries) {
        if (!entries) return;
        native.scans.store(entries, std::memory_order_release);
        ++given_;
    }

    void give_up(const std::string& why) {
        if (!is_given_up_.exchange(true)) tell_(why);
    }

    /// Until there is nothing to do.
    void work() {
        std::unique_lock lock(mutex_);
        while (!jobs_.empty()) {
            const Job job = std::move(jobs_.front());
            jobs_.pop_front();
            lock.unlock();
            const NativeEntry* entries = nullptr;
            try {
                if (!is_given_up_) entries = make(job);
            } catch (const std::exception& why) {
                give_up(why.what());
            }
            lock.lock();
            Made& made = made_[job.key];
            made.entries = entries;
            for (const auto& native : std::exchange(made.waiting, {})) give(*native, entries);
        }
        is_busy_ = false;
        idle_.notify_all();
    }

    /// Null where another process has the compiler, and this one ends.
    const NativeEntry* make(const Job& job) {
        while (!cache_->lock()) {
            if (is_ending_) return nullptr;
            std::this_thread::sleep_for(50ms);
        }
        void* library = cache_->load(job.key);
        if (!library) {
            compile(job);
            library = cache_->load(job.key);
        }
        cache_->unlock();
        if (!library) throw NoCompiledCode("what the compiler has made is not there any more");
        return begin(library);
    }

    void compile(const Job& job) {
        const std::string own = cache_->path(fmt::format("{:010}", ::getpid())),
                          source = own + ".cpp", made = own + ".so", log = own + ".log";
        std::string wrong;
        std::ofstream written(source);
        if (written << job.text; !written.flush())
            wrong = fmt::format("cannot write {}: {}", source, std::strerror(errno));
        else if (const std::string end = run(source, made, log); !end.empty())
            wrong = fmt::format("{} failed: {}", compiler_.words[0], said(log, end));
        for (const std::string& file : {source, log}) ::unlink(file.c_str());
        if (wrong.empty()) return cache_->keep(made, job.key);
        ::unlink(made.c_str());
        throw NoCompiledCode(wrong);
    }

    /// The first line of what the compiler has said, or, where it said nothing, how it ended.
    static std::string said(const std::string& log, const std::string& end) {
        std::string first;
        std::ifstream text(log);
        std::getline(text, first);
        return first.empty() ? end : first;
    }

    /// How it ended; empty: well.
    std::string run(const std::string& source, const std::string& made, const std::string& log) {
        std::vector<std::string> words = compiler_.words;
        words.insert(words.end(), std::begin(flags), std::end(flags));
        words.insert(words.end(), {"-o", made, source});
        std::vector<char*> arguments;
        for (std::string& word : words) arguments.push_back(word.data());
        arguments.push_back(nullptr);
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(),
                                         O_WRONLY | O_CREAT | O_TRUNC, 0600);
        posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
        pid_t process = 0;
        const int error =
            ::posix_spawnp(&process, arguments[0], &actions, nullptr, arguments.data(), environ);
        posix_spawn_file_actions_destroy(&actions);
        if (error != 0) return std::strerror(error);
        process_ = process;
        int status = 0;
        while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
        }
        process_ = 0;
        if (!WIFEXITED(status)) return fmt::format("signal {}", WTERMSIG(status));
        return WEXITSTATUS(status) == 0 ? "" : fmt::format("exit code {}", WEXITSTATUS(status));
    }

    void (*tell_)(const std::string&);
    const std::vector<std::string_view> names_ = external_names();
    std::atomic<bool> is_given_up_ = false, is_ending_ = false;
    std::atomic<pid_t> process_ = 0;
    std::mutex mutex_;  ///< of what is below
    std::condition_variable idle_;
    Compiler compiler_;
    std::optional<Cache> cache_;
    std::map<std::string, Made> made_;
    std::deque<Job> jobs_;
    bool is_busy_ = false;
    std::size_t given_ = 0;
};

/// Lives as long as the process: its thread may be the last.
std::atomic<Compiling*> compiling = nullptr;
std::atomic<bool> is_asked = false;

}  // namespace

void compile_natively(void (*tell)(const std::string& why)) {
    if (!compiling && tell) compiling = new Compiling(tell);
    is_asked = tell != nullptr;
}

void compile_code(const Code& code, const std::shared_ptr<Native>& native) {
    if (is_asked) compiling.load()->ask(code, native);
}

std::size_t end_compiling() {
    return compiling ? compiling.load()->end() : 0;
}

#else

void compile_natively(void (*tell)(const std::string& why)) {
    if (tell) tell("native code is made for x86-64 only");
}

void compile_code(const Code&, const std::shared_ptr<Native>&) {}

std::size_t end_compiling() {
    return 0;
}

#endif

}  // namespace lineshaft::st
