// SPDX-License-Identifier: MIT
/// assimp's C functions, loaded where a file needs them (base/shared_library.hpp): with it come dozens of formats that are not read here.
#pragma once

#include <assimp/cimport.h>

namespace fettle::core::mesh_files {

/// As cimport.h declares them.
struct AssimpLibrary {
    decltype(&aiImportFile) import_file;
    decltype(&aiReleaseImport) release_import;
    decltype(&aiGetErrorString) error_string;
};

/// Throws base::MissingLibrary.
const AssimpLibrary& assimp_library();

}  // namespace fettle::core::mesh_files
