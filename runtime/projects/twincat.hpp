#pragma once

#include <filesystem>
#include <string_view>

#include "runtime/projects/project.hpp"
#include "runtime/projects/xml.hpp"

namespace lineshaft::projects {

/// `.TcPOU`, `.TcDUT`, `.TcGVL`, `.TcIO`: one declaration with what belongs to it, as one text.
/// `.TcTTO`: a task.
void read_twincat_object(const Reading& to, const std::string& path, const Mark& where);

/// The same of a file that is read already, whose texts have the dialect of that ending.
void add_twincat_objects(const Reading& to, const XmlFile& file, std::string_view read_as = {});

/// `POUs\MAIN.TcPOU`, from the folder of the file that names it. Capital letters make no
/// difference on Windows: where there is no such file, one that differs in them is meant.
std::string path_beside(const std::filesystem::path& named_by, std::string text);

/// `.plcproj`: the files that it lists, and the libraries that it refers to.
void read_plcproj(const Reading& to, const std::string& path, const Mark& where);

}  // namespace lineshaft::projects
