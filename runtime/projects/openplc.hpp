#pragma once

#include "runtime/projects/project.hpp"

namespace lineshaft::projects {

/// `project.json` of OpenPLC Editor 4, by its beginning.
bool is_openplc_project(const std::filesystem::path& file);

/// A POU of such a project, which is in its folder `pous`.
bool is_openplc_pou(const std::filesystem::path& file);

/// Below the folder of such a project, and read with it, or made out of it by the editor.
bool is_left_to_openplc(const std::filesystem::path& file);

/// Tasks, programs and globals of a project, and all below its folders `pous` and `datatypes`.
void read_openplc_project(const Reading& to, const std::string& path, const Mark& where);

/// Declarations as text, `name : TYPE AT %IX0.0`, and behind them Structured Text, or a ladder; of
/// C++ and Python the declarations alone are taken.
void read_openplc_pou(const Reading& to, const std::string& path, const Mark& where);

}  // namespace lineshaft::projects
