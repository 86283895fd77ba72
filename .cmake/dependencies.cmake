# SPDX-License-Identifier: MIT
# The libraries that fettle stands on. Read by the build and by the installed package, so that both find the same ones.
# Debian's names for them: .ci/packages.txt.
include(CMakeFindDependencyMacro)
find_dependency(Threads)
find_dependency(Eigen3 3.4 NO_MODULE)
find_dependency(TBB 2021)
find_dependency(NLopt 2.7)
find_dependency(assimp 5.2)
find_dependency(ZLIB)
find_dependency(EXPAT 2.4)
find_dependency(nlohmann_json 3.11)
find_dependency(PkgConfig)
if(NOT TARGET PkgConfig::IPOPT)
  pkg_check_modules(IPOPT REQUIRED QUIET IMPORTED_TARGET GLOBAL ipopt)
endif()
if(NOT TARGET PkgConfig::LIBZIP)
  pkg_check_modules(LIBZIP REQUIRED QUIET IMPORTED_TARGET GLOBAL libzip)
endif()
