#include "runtime/program/shared_folder.hpp"

namespace lineshaft {

namespace fs = std::filesystem;

namespace {

fs::path find_shared_folder() {
    std::error_code unknown;
    const fs::path command = fs::read_symlink("/proc/self/exe", unknown);
    if (unknown) return {};
    fs::path folder = command.parent_path();
    if (fs::path installed = folder.parent_path() / "share" / "lineshaft";
        fs::is_directory(installed / "config", unknown))
        return installed;
    for (; folder != folder.root_path(); folder = folder.parent_path())
        if (fs::is_regular_file(folder / "config" / "program.schema.json", unknown)) return folder;
    return {};
}

}  // namespace

const fs::path& shared_folder() {
    static const fs::path folder = find_shared_folder();
    return folder;
}

}  // namespace lineshaft
