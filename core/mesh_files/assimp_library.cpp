// SPDX-License-Identifier: MIT
#include "fettle/core/mesh_files/assimp_library.hpp"

#include "fettle/core/base/shared_library.hpp"

namespace fettle::core::mesh_files {
namespace {

AssimpLibrary load_assimp() {
    AssimpLibrary out{};
#ifdef FETTLE_ASSIMP_NAME
    const base::SharedLibrary library(FETTLE_ASSIMP_NAME, FETTLE_ASSIMP_PATH);
    library.find("aiImportFile", out.import_file);
    library.find("aiReleaseImport", out.release_import);
    library.find("aiGetErrorString", out.error_string);
#else
    out = {&aiImportFile, &aiReleaseImport, &aiGetErrorString};
#endif
    return out;
}

}  // namespace

const AssimpLibrary& assimp_library() {
    static const AssimpLibrary library = load_assimp();
    return library;
}

}  // namespace fettle::core::mesh_files
