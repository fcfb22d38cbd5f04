/* Preloaded by tests/fault/fault.py: lets the N-th call of one kind fail, as a disk or a machine at its end would.
   FAULT_KIND write, fsync, syncfs, rename, open or malloc; FAULT_AT N, from 1, 0 for none. Calls from main() on are
   counted; their number goes to the file FAULT_REPORT. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static atomic_long calls;
static long fault_at;
static const char* fault_kind;
static atomic_int counting;

static int fails(const char* kind, int error) {
    if (!counting || strcmp(fault_kind, kind) != 0 || ++calls != fault_at) return 0;
    errno = error;
    return 1;
}

static int is_output(const void* file) { return file != stdout && file != stderr; }

size_t fwrite(const void* data, size_t size, size_t count, FILE* file) {
    static size_t (*next)(const void*, size_t, size_t, FILE*);
    if (!next) next = (size_t(*)(const void*, size_t, size_t, FILE*))dlsym(RTLD_NEXT, "fwrite");
    return is_output(file) && fails("write", ENOSPC) ? 0 : next(data, size, count, file);
}

int fflush(FILE* file) {
    static int (*next)(FILE*);
    if (!next) next = (int (*)(FILE*))dlsym(RTLD_NEXT, "fflush");
    return is_output(file) && fails("write", ENOSPC) ? EOF : next(file);
}

int fsync(int descriptor) {
    static int (*next)(int);
    if (!next) next = (int (*)(int))dlsym(RTLD_NEXT, "fsync");
    return fails("fsync", EIO) ? -1 : next(descriptor);
}

int syncfs(int descriptor) {
    static int (*next)(int);
    if (!next) next = (int (*)(int))dlsym(RTLD_NEXT, "syncfs");
    return fails("syncfs", EIO) ? -1 : next(descriptor);
}

int rename(const char* from, const char* to) {
    static int (*next)(const char*, const char*);
    if (!next) next = (int (*)(const char*, const char*))dlsym(RTLD_NEXT, "rename");
    return fails("rename", EIO) ? -1 : next(from, to);
}

FILE* fopen(const char* path, const char* mode) {
    static FILE* (*next)(const char*, const char*);
    if (!next) next = (FILE * (*)(const char*, const char*)) dlsym(RTLD_NEXT, "fopen");
    return fails("open", EMFILE) ? NULL : next(path, mode);
}

int open(const char* path, int flags, ...) {
    static int (*next)(const char*, int, ...);
    va_list rest;
    va_start(rest, flags);
    const int mode = flags & (O_CREAT | O_TMPFILE) ? va_arg(rest, int) : 0;
    va_end(rest);
    if (!next) next = (int (*)(const char*, int, ...))dlsym(RTLD_NEXT, "open");
    return fails("open", EMFILE) ? -1 : next(path, flags, mode);
}

extern void* __libc_malloc(size_t size);

void* malloc(size_t size) { return fails("malloc", ENOMEM) ? NULL : __libc_malloc(size); }

static int (*real_main)(int, char**, char**);

static int counted_main(int argc, char** argv, char** environment) {
    const char* at = getenv("FAULT_AT");
    const char* report = getenv("FAULT_REPORT");
    fault_kind = getenv("FAULT_KIND");
    fault_at = at ? atol(at) : 0;
    counting = fault_kind != NULL;
    const int code = real_main(argc, argv, environment);
    counting = 0;
    FILE* file = report ? fopen(report, "w") : NULL;
    if (file) {
        fprintf(file, "%ld\n", (long)calls);
        fclose(file);
    }
    return code;
}

/* The C library's start of every program: puts counted_main() around its main(). */
int __libc_start_main(int (*main)(int, char**, char**), int argc, char** argv, void (*init)(void),
                      void (*fini)(void), void (*rtld_fini)(void), void* stack_end) {
    int (*next)(int (*)(int, char**, char**), int, char**, void (*)(void), void (*)(void),
                void (*)(void), void*);
    next = dlsym(RTLD_NEXT, "__libc_start_main");
    real_main = main;
    return next(counted_main, argc, argv, init, fini, rtld_fini, stack_end);
}
