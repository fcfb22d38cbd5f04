/* Preloaded by tests/fault/fault.py: lets the N-th call of one kind fail, as a disk or a machine at its end would.
   FAULT_KIND write, disk (write and fdatasync of a file), fsync, syncfs, rename, open, malloc, thread or accept; FAULT_AT N, from 1, 0 for none. Calls from main() on are
   counted; their number goes to the file FAULT_REPORT. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

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

static int is_file(int descriptor) {
    struct stat file;
    return descriptor > STDERR_FILENO && fstat(descriptor, &file) == 0 && S_ISREG(file.st_mode);
}

ssize_t write(int descriptor, const void* data, size_t size) {
    static ssize_t (*next)(int, const void*, size_t);
    if (!next) next = (ssize_t(*)(int, const void*, size_t))dlsym(RTLD_NEXT, "write");
    return is_file(descriptor) && fails("disk", ENOSPC) ? -1 : next(descriptor, data, size);
}

int fdatasync(int descriptor) {
    static int (*next)(int);
    if (!next) next = (int (*)(int))dlsym(RTLD_NEXT, "fdatasync");
    return fails("disk", EIO) ? -1 : next(descriptor);
}

int pthread_create(pthread_t* thread, const pthread_attr_t* how, void* (*work)(void*), void* with) {
    static int (*next)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
    if (!next)
        next = (int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*))dlsym(
            RTLD_NEXT, "pthread_create");
    return fails("thread", EAGAIN) ? EAGAIN : next(thread, how, work, with);
}

int accept4(int descriptor, struct sockaddr* address, socklen_t* size, int flags) {
    static int (*next)(int, struct sockaddr*, socklen_t*, int);
    if (!next)
        next = (int (*)(int, struct sockaddr*, socklen_t*, int))dlsym(RTLD_NEXT, "accept4");
    return fails("accept", EMFILE) ? -1 : next(descriptor, address, size, flags);
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
