#include "runtime/serve/http_session.hpp"

#include <filesystem>

#include <dlfcn.h>
#include <sys/auxv.h>

namespace lineshaft {

namespace {

namespace fs = std::filesystem;

/// Beside the command where it was built, or below the folder that it was installed into.
fs::path shared_object() {
    constexpr const char* name = "lineshaft_http.so";
    std::error_code unknown;
    const auto* command = reinterpret_cast<const char*>(getauxval(AT_EXECFN));
    const fs::path folder = fs::canonical(command, unknown).parent_path();
    const fs::path built = folder / name;
    if (fs::exists(built, unknown)) return built;
    return folder.parent_path() / LINESHAFT_LIBRARIES / "lineshaft" / name;
}

}  // namespace

std::unique_ptr<HttpSession> HttpSession::load(World& world, AnswerHttp answer,
                                               const std::atomic<bool>& ends, std::string& error) {
    void* const library = dlopen(shared_object().c_str(), RTLD_NOW | RTLD_LOCAL);
    void* const begin = library ? dlsym(library, "lineshaft_http_session") : nullptr;
    if (!begin) {
        const char* const why = dlerror();
        error = why ? why : "the shared object has no lineshaft_http_session";
        return nullptr;
    }
    const auto make = reinterpret_cast<decltype(&lineshaft_http_session)>(begin);
    return std::unique_ptr<HttpSession>(make(world, std::move(answer), ends));
}

}  // namespace lineshaft
