// Preloaded into a program, counts what each of its threads asks for: memory from malloc() and its
// like, and pages from mmap() and brk(). ALLOCATION_LOG names the file that the counts are written
// to when the program ends; ALLOCATION_LOG_AFTER tells from how many seconds on, counted from the
// start, it counts, and ALLOCATION_LOG_UNTIL up to how many. The first of each thread are written with the addresses that they came from.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <execinfo.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

enum { kThreads = 64, kName = 16, kTraces = 8, kDepth = 24 };

struct Thread {
  char name[kName];
  _Atomic unsigned long count;
};

static struct Thread threads[kThreads];
static _Atomic int thread_count;
static _Thread_local int own = -1;  // number of this thread
static _Thread_local int is_counting;
static double start, after, until;
static int file = -1;

static void* (*real_malloc)(size_t);
static void* (*real_calloc)(size_t, size_t);
static void* (*real_realloc)(void*, size_t);
static void* (*real_aligned)(size_t, size_t);
static int (*real_posix)(void**, size_t, size_t);
static void* (*real_mmap)(void*, size_t, int, int, int, off_t);
static int (*real_brk)(void*);
static void* (*real_sbrk)(intptr_t);
static void (*real_free)(void*);

// dlsym() itself asks for memory before it has found malloc().
static char early[1 << 16];
static size_t early_used;

static void* take_early(size_t size) {
  void* memory = early + early_used;
  early_used += (size + 15) & ~(size_t)15;
  return early_used <= sizeof early ? memory : NULL;
}

static int is_early(const void* memory) {
  return (const char*)memory >= early && (const char*)memory < early + sizeof early;
}

// What other libraries start may ask for memory before this one has.
static int find_real(void) {
  static int is_finding;
  if (real_realloc != NULL) return 1;
  if (is_finding) return 0;
  is_finding = 1;
  real_calloc = dlsym(RTLD_NEXT, "calloc");
  real_malloc = dlsym(RTLD_NEXT, "malloc");
  real_aligned = dlsym(RTLD_NEXT, "aligned_alloc");
  real_posix = dlsym(RTLD_NEXT, "posix_memalign");
  real_mmap = dlsym(RTLD_NEXT, "mmap");
  real_brk = dlsym(RTLD_NEXT, "brk");
  real_sbrk = dlsym(RTLD_NEXT, "sbrk");
  real_free = dlsym(RTLD_NEXT, "free");
  real_realloc = dlsym(RTLD_NEXT, "realloc");
  return 1;
}

static double now(void) {
  struct timespec time;
  clock_gettime(CLOCK_MONOTONIC, &time);
  return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static void count(const char* what, size_t size) {
  if (file < 0 || is_counting) return;
  const double age = now() - start;
  if (age < after || age > until) return;
  is_counting = 1;
  if (own < 0) {
    own = atomic_fetch_add(&thread_count, 1);
    if (own < kThreads) pthread_getname_np(pthread_self(), threads[own].name, kName);
  }
  if (own < kThreads && atomic_fetch_add(&threads[own].count, 1) < kTraces) {
    void* trace[kDepth];
    const int depth = backtrace(trace, kDepth);
    dprintf(file, "# %s of %zu bytes in %s\n", what, size, threads[own].name);
    backtrace_symbols_fd(trace, depth, file);
  }
  is_counting = 0;
}

static double seconds_of(const char* name) {
  const char* text = getenv(name);
  return text == NULL ? 0 : atof(text);
}

__attribute__((constructor)) static void begin(void) {
  find_real();
  void* trace[2];
  backtrace(trace, 2);  // loads what it needs
  start = now();
  const char* path = getenv("ALLOCATION_LOG");
  after = seconds_of("ALLOCATION_LOG_AFTER");
  until = seconds_of("ALLOCATION_LOG_UNTIL");
  if (path != NULL) file = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
}

__attribute__((destructor)) static void end(void) {
  if (file < 0) return;
  const int log = file;
  file = -1;
  for (int i = 0; i < thread_count && i < kThreads; ++i) {
    dprintf(log, "%s %lu\n", threads[i].name, threads[i].count);
  }
  dprintf(log, "end\n");
}

void* malloc(size_t size) {
  if (!find_real()) return take_early(size);
  count("malloc", size);
  return real_malloc(size);
}
void* calloc(size_t number, size_t size) {
  if (!find_real()) return take_early(number * size);
  count("calloc", number * size);
  return real_calloc(number, size);
}
void* realloc(void* memory, size_t size) {
  if (!find_real()) return take_early(size);
  if (is_early(memory)) {
    void* moved = real_malloc(size);
    const size_t room = (size_t)(early + sizeof early - (char*)memory);
    return memcpy(moved, memory, size < room ? size : room);
  }
  count("realloc", size);
  return real_realloc(memory, size);
}
void* aligned_alloc(size_t alignment, size_t size) {
  find_real();
  count("aligned_alloc", size);
  return real_aligned(alignment, size);
}
int posix_memalign(void** memory, size_t alignment, size_t size) {
  find_real();
  count("posix_memalign", size);
  return real_posix(memory, alignment, size);
}
void free(void* memory) {
  if (memory == NULL || is_early(memory) || !find_real()) return;
  real_free(memory);
}
void* mmap(void* address, size_t size, int protection, int flags, int descriptor, off_t offset) {
  find_real();
  count("mmap", size);
  return real_mmap(address, size, protection, flags, descriptor, offset);
}
int brk(void* end_of_data) {
  find_real();
  count("brk", 0);
  return real_brk(end_of_data);
}
void* sbrk(intptr_t increment) {
  find_real();
  count("sbrk", (size_t)increment);
  return real_sbrk(increment);
}
