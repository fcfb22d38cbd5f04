#include "runtime/trace/output_set.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <set>

#include <fmt/format.h>

#include "runtime/csv/csv_metadata.hpp"
#include "runtime/trace/folder_locks.hpp"

namespace lineshaft {

bool OutputSet::check(const OutputFile& file) {
    if (error_.empty()) error_ = file.error();
    return file.error().empty();
}

void OutputSet::complete(OutputFile& file) {
    if (flushes_)
        file.complete();
    else
        file.flush();
    check(file);
}

void OutputSet::add(std::unique_ptr<OutputFile> file, std::string sidecar) {
    complete(*file);
    entries_.push_back({std::move(file), std::move(sidecar)});
}

bool OutputSet::commit() {
    std::vector<std::unique_ptr<OutputFile>> sidecars;
    for (const Entry& entry : entries_) {
        if (entry.sidecar.empty() || !entry.file->is_regular() || !error_.empty()) continue;
        sidecars.push_back(std::make_unique<OutputFile>(sidecar_path(entry.file->path())));
        sidecars.back()->write(entry.sidecar);
        complete(*sidecars.back());
    }
    const bool done = error_.empty() && publish(sidecars);
    entries_.clear();
    return done;
}

bool OutputSet::publish(std::vector<std::unique_ptr<OutputFile>>& sidecars) {
    std::set<std::string> folders;
    for (const Entry& entry : entries_)
        if (entry.file->is_regular()) folders.insert(folder_of(entry.file->path()));
    const FolderLocks locks(folders);
    std::error_code none;  // then a later step tells what is wrong
    for (const Entry& entry : entries_)
        if (entry.file->is_regular())
            std::filesystem::remove(sidecar_path(entry.file->path()), none);
    for (const Entry& entry : entries_)
        if (!entry.file->publish()) return check(*entry.file);
    for (const auto& sidecar : sidecars)
        if (!sidecar->publish()) return check(*sidecar);
    if (!flushes_ || locks.flush()) return true;
    error_ = fmt::format("cannot flush the folder of '{}': {}", entries_.front().file->path(),
                         std::strerror(errno));
    return false;
}

void OutputSet::save(StateWriter& out) {
    out.put(std::uint64_t{entries_.size()});
    for (const Entry& entry : entries_) {
        out.put(entry.file->path());
        entry.file->save(out);
        out.put(entry.sidecar);
        check(*entry.file);
    }
}

void OutputSet::restore(StateReader& in, const std::vector<std::string>& known) {
    std::uint64_t count = 0;
    in.get(count, 0, known.size());
    for (; in.ok() && entries_.size() < count;) {
        std::string path, sidecar;
        in.get(path);
        in.require(std::ranges::find(known, path) != known.end(), "a file");
        if (!in.ok()) return;
        auto file = std::make_unique<OutputFile>(path, in);
        in.get(sidecar);
        check(*file);
        entries_.push_back({std::move(file), std::move(sidecar)});
    }
}

}  // namespace lineshaft
