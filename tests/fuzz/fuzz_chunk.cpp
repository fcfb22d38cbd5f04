/// Any bytes as a chunk of a study, after a NUL its sidecar: it is taken as what it is, or not.

#include <cstdlib>
#include <fstream>

#include "blocks/catalog.hpp"
#include "runtime/study/merge.hpp"
#include "runtime/study/study_reader.hpp"
#include "tests/fuzz/fuzz_folder.hpp"

using namespace lineshaft;

namespace {

struct Project {
    Project() {
        std::filesystem::create_directory(folder.path + "/parts");
        std::ofstream(folder.path + "/p.yaml")
            << "lineshaft: 1\nparameters: {speed: 10 mm/s}\ntasks: {main: {every: 1 ms}}\nblocks:\n"
               "  x: {type: axis, task: main}\n  f: {type: MC_MoveVelocity, task: main, Axis: x, "
               "Velocity: $speed, Execute: true}\nrun: {for: 5 ms}\n";
        std::ofstream(folder.path + "/s.yaml")
            << "lineshaft_study: 1\nprogram: p.yaml\ncompare: {x.velocity: {at_least: 0 mm/s}}\n"
               "cases: [grid: {speed: [1 mm/s, 2 mm/s]}]\n";
        Diagnostics out;
        study = read_study(read_source(folder.path + "/s.yaml", out), {}, standard_blocks(), out,
                           StudyCheck::groups);
        if (!out.empty()) std::abort();
    }

    test::FuzzFolder folder;
    Study study;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static Project project;
    static const StudyCsv csv(project.study);
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const std::size_t end = text.find('\0');
    const std::string path = project.folder.path + "/parts/part_1.csv";
    std::ofstream(path, std::ios::binary) << text.substr(0, end);
    // So that most inputs get behind the comparison of the study.
    std::string sidecar(end == text.npos ? "" : text.substr(end + 1));
    if (const auto at = sidecar.find("STUDY"); at != std::string::npos)
        sidecar.replace(at, 5, project.study.identity);
    std::ofstream(path + "-metadata.json", std::ios::binary) << sidecar;
    Diagnostics out;
    const auto chunks = find_chunks(project.folder.path + "/parts", project.study, csv, out);
    out.render();
    if (chunks.empty() == out.empty()) std::abort();
    ResultReader reader(path, csv);
    while (reader.next()) continue;
    return 0;
}
