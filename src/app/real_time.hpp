#pragma once

#include <initializer_list>
#include <thread>

namespace scree {

/// Gives threads that start from now on stacks of 1 MiB: the whole of a stack is locked, and most
/// systems give 8.
void make_stacks_small();

/// Lets threads run before all ordinary ones (SCHED_FIFO), but for those that were never started.
/// Says in the log, once, where this process has no right to.
void run_first(std::initializer_list<std::thread*> threads);

/// Keeps the memory that this process has in RAM, so that no thread waits for a page. Says in the
/// log where it has no right to.
void lock_memory();

}  // namespace scree
