# SPDX-License-Identifier: MIT
# `cpack --config build/release/CPackConfig.cmake` makes a Debian package, and a tar file of the same tree for any prefix.
set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON)  # what has been built is packed; not the tests for it
set(CPACK_GENERATOR DEB TGZ)
set(CPACK_PACKAGE_NAME fettle)
set(CPACK_PACKAGE_VENDOR fettle)
set(CPACK_PACKAGE_CONTACT "fettle <fettle@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGE_FILE_NAME "fettle_${PROJECT_VERSION}_${CMAKE_SYSTEM_PROCESSOR}")
set(CPACK_PACKAGE_CHECKSUM SHA256)
set(CPACK_RESOURCE_FILE_LICENSE "${PROJECT_SOURCE_DIR}/LICENSE")
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
# What is linked is found by dpkg-shlibdeps; what is loaded where it is first needed (load_on_use.cmake) has to be named.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "coinor-libipopt1v5, libnlopt0, libassimp5, libzip4, libcairo2, fonts-dejavu-core")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "python3-numpy, libcholmod3, libumfpack5, libspqr2, libopenblas0")
if(FETTLE_WITH_STEP)  # the program that reads STEP is carried as bytes: no tool sees what it links
  string(APPEND CPACK_DEBIAN_PACKAGE_RECOMMENDS ", libocct-data-exchange-7.6")
endif()
set(CPACK_DEBIAN_PACKAGE_SUGGESTS
  "g++, cmake, libeigen3-dev, libtbb-dev, libnlopt-dev, libassimp-dev, zlib1g-dev, libzip-dev, libcairo2-dev, libexpat1-dev, nlohmann-json3-dev, coinor-libipopt-dev, libsuitesparse-dev, pkg-config")
include(CPack)
