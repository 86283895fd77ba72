// SPDX-License-Identifier: MIT
/// The program's memory: when it comes from the system and when it goes back (by the GNU C library; with others nothing is done), and what
/// happens where there is none.
#pragma once

#include <cstddef>
#include <functional>

namespace fettle::design::cli {

/// A step's matrices are made and dropped hundreds of times a second: memory that went back to the system each time would be a tenth of a
/// long simulation.
void keep_freed_memory();

/// The first use of each page of memory costs over a microsecond: the system clears it. This lets another thread have so many bytes for
/// the caller cleared, while the caller does what does not need them yet.
/// @return what the other thread is to do, once; until then the caller has as much less. Empty where there is nothing to do.
std::function<void()> memory_ahead(std::size_t bytes);

/// From now on memory that cannot be had is std::bad_alloc, with a reserve set free for what then unwinds. Where that is not enough, or a
/// destructor cannot be left, the program ends as end_out_of_memory does, never by a signal.
/// @param json  is the answer wanted as JSON?
void expect_out_of_memory(bool json);

/// The program's end, in main: whoever ends it before, by exit(), is a library that computes, which does so where it gets no memory
/// (Fortran's does, with codes of its own). From expect_out_of_memory on that is told and is exit code 3, too. @return code
int ended(int code);

/// Says so, with memory that is there already, and ends the program with exit code 3.
[[noreturn]] void end_out_of_memory();

}  // namespace fettle::design::cli
