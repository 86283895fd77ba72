# SPDX-License-Identifier: MIT
# fettle_load_on_use(TARGET NAME LIBRARY SOURCE [FILE]): SOURCE of TARGET gets the library's functions at run time, through
# core/base/shared_library.hpp. LIBRARY is an imported target, FILE its library where the target does not say.
# A shared library with a name of its own (ELF's SONAME) is compiled against and not linked: FETTLE_<NAME>_NAME and FETTLE_<NAME>_PATH tell
# SOURCE what to load. Any other, such as a static one, is linked, and without these macros SOURCE takes the functions as they are.
option(FETTLE_LOAD_ON_USE "Load Ipopt, NLopt, libzip and cairo where they are first needed, not at every start" ON)

# The library's file; empty if the target does not say.
function(fettle_library_file library result)
  set(${result} "" PARENT_SCOPE)
  get_target_property(configurations ${library} IMPORTED_CONFIGURATIONS)
  set(properties IMPORTED_LOCATION)
  foreach(configuration IN LISTS configurations)
    list(APPEND properties IMPORTED_LOCATION_${configuration})
  endforeach()
  foreach(property IN LISTS properties)
    get_target_property(found ${library} ${property})
    if(found)
      set(${result} "${found}" PARENT_SCOPE)
      return()
    endif()
  endforeach()
endfunction()

# The name that the loader looks for; empty if the file is no shared library of ELF.
function(fettle_library_name file result)
  set(${result} "" PARENT_SCOPE)
  if(NOT file OR NOT CMAKE_READELF OR file MATCHES "\\.a$")
    return()
  endif()
  execute_process(COMMAND "${CMAKE_READELF}" -d "${file}" OUTPUT_VARIABLE text ERROR_QUIET)
  if(text MATCHES "SONAME[^\n]*\\[([^\n]+)\\]")
    set(${result} "${CMAKE_MATCH_1}" PARENT_SCOPE)
  endif()
endfunction()

function(fettle_load_on_use target name library source)
  set(file "${ARGN}")
  if(NOT file)
    fettle_library_file(${library} file)
  endif()
  fettle_library_name("${file}" loaded)
  if(NOT FETTLE_LOAD_ON_USE OR NOT loaded)
    target_link_libraries(${target} PRIVATE ${library})
    return()
  endif()
  set(headers fettle_${name}_headers)
  add_library(${headers} INTERFACE)
  target_include_directories(${headers} SYSTEM INTERFACE "$<TARGET_PROPERTY:${library},INTERFACE_INCLUDE_DIRECTORIES>")
  target_compile_definitions(${headers} INTERFACE "$<TARGET_PROPERTY:${library},INTERFACE_COMPILE_DEFINITIONS>")
  target_compile_options(${headers} INTERFACE "$<TARGET_PROPERTY:${library},INTERFACE_COMPILE_OPTIONS>")
  target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:${headers}>)
  set_property(SOURCE ${source} TARGET_DIRECTORY ${target} APPEND PROPERTY COMPILE_DEFINITIONS
    "FETTLE_${name}_NAME=\"${loaded}\"" "FETTLE_${name}_PATH=\"${file}\"")
endfunction()
