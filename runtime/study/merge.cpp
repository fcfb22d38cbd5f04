#include "runtime/study/merge.hpp"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "runtime/source/codes.hpp"

namespace lineshaft {

namespace fs = std::filesystem;

namespace {

struct Part {
    std::string path;
    ResultIdentity identity;
};

/// Sorted by name.
std::vector<Part> find_parts(const std::string& folder, Diagnostics& out) {
    std::error_code error;
    std::vector<std::string> paths;
    for (auto it = fs::directory_iterator(folder, error); !error && it != fs::directory_iterator();
         it.increment(error))
        if (it->path().extension() == ".csv") paths.push_back(it->path().string());
    if (error)
        out.add(code::file_cannot_be_read, {},
                fmt::format("cannot read '{}': {}", folder, error.message()));
    std::ranges::sort(paths);
    std::vector<Part> parts;
    for (const std::string& path : paths)
        if (auto identity = read_identity(path); !identity)
            continue;
        else if (identity->is_damaged)
            out.add(code::chunk_of_another_study, {},
                    fmt::format("the sidecar of '{}' names no chunk", path),
                    "compute it again, or move it out of the folder");
        else if (identity->chunk)
            parts.push_back({path, std::move(*identity)});
    return parts;
}

/// 3, 5-7.
std::string ranges(const std::vector<std::int64_t>& numbers) {
    std::string text;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        std::size_t last = i;
        while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
        text += fmt::format("{}{}", text.empty() ? "" : ", ", numbers[i]);
        if (last > i) text += fmt::format("-{}", numbers[last]);
        i = last;
    }
    return text;
}

bool belongs(const Part& part, std::int64_t of, const Study& study, Diagnostics& out) {
    const Chunk& chunk = *part.identity.chunk;
    if (part.identity.study != study.identity)
        out.add(code::chunk_of_another_study, {},
                fmt::format("'{}' was computed from another plan or program", part.path),
                "compute it again, or move it out of the folder");
    else if (chunk.of != of)
        out.add(code::chunk_of_another_study, {},
                fmt::format("'{}' is chunk {} of {}, others are of {}", part.path, chunk.index,
                            chunk.of, of),
                "keep the chunks of one division in the folder");
    return part.identity.study == study.identity && chunk.of == of;
}

bool is_whole(const Part& part, const Study& study, const StudyCsv& csv, Diagnostics& out) {
    const Chunk& chunk = *part.identity.chunk;
    const ResultFile file(part.path, study, csv, chunk);
    if (file.take_whole([](const CaseResult&) {})) return true;
    out.add(code::damaged_chunk, {},
            fmt::format("'{}' is not what its sidecar describes", part.path),
            fmt::format("compute it again: --chunk {}/{} -o {}", chunk.index, chunk.of, part.path));
    return false;
}

}  // namespace

std::vector<std::string> find_chunks(const std::string& folder, const Study& study,
                                     const StudyCsv& csv, Diagnostics& out) {
    const std::vector<Part> parts = find_parts(folder, out);
    if (parts.empty() && out.empty())
        out.add(code::chunks_are_missing, {}, fmt::format("there is no chunk in '{}'", folder),
                "compute them with --chunk 1/4 -o FOLDER/part_1.csv and so on");
    if (!out.empty()) return {};
    const std::int64_t of = parts.front().identity.chunk->of;
    std::map<std::int64_t, const Part*> found;
    for (const Part& part : parts)
        if (belongs(part, of, study, out) && is_whole(part, study, csv, out))
            found.emplace(part.identity.chunk->index, &part);
    if (!out.empty()) return {};
    std::vector<std::int64_t> missing;
    for (std::int64_t i = 1; i <= of; ++i)
        if (!found.contains(i)) missing.push_back(i);
    if (!missing.empty()) {
        out.add(code::chunks_are_missing, {},
                fmt::format("of {} chunks in '{}' {} missing: {}", of, folder,
                            missing.size() == 1 ? "one is" : fmt::format("{} are", missing.size()),
                            ranges(missing)),
                fmt::format("compute it: lineshaft study {} --chunk {}/{} -o {}/part_{}.csv",
                            study.file->path, missing.front(), of, folder, missing.front()));
        return {};
    }
    std::vector<std::string> paths;
    for (const auto& [index, part] : found) paths.push_back(part->path);
    return paths;
}

}  // namespace lineshaft
