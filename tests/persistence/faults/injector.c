// Preloaded into a process: counts the calls that change files below one folder, and ends the process or fails at call number k.
//
// fault_arm(folder, call, action, stop, log) starts the count; calls are counted from 1. Before call number `stop` the process gets SIGTERM.
// What only reads is not counted: a process that ends before a read leaves what it leaves before the next change. Every counted call is
// written to the log, one line each: number, name, path.
// C++ streams and Python's files both come through these functions of the C library (streams open with fopen and write with write).

#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/sendfile.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

enum { COUNT, END_BEFORE, END_HALFWAY, DISK_FULL };

static char folder[PATH_MAX];
static size_t folder_length;
static long calls, target, stop_at;
static int armed, action, log_file = -1;

void fault_arm(const char* path, long call, int what, long stop, const char* log)
{
	folder_length = strlen(strncpy(folder, path, PATH_MAX - 1));
	calls = 0, target = call, action = what, stop_at = stop;
	log_file = (int)syscall(SYS_openat, AT_FDCWD, log, O_CREAT | O_WRONLY | O_TRUNC | O_CLOEXEC, 0644);
	armed = 1;
}

static void end_process(void) { syscall(SYS_kill, getpid(), SIGKILL); }

static int below(const char* path)
{
	return !strncmp(path, folder, folder_length) && (path[folder_length] == '/' || !path[folder_length]);
}

// The path of a file descriptor, or of a name in a folder; 0 when there is none.
static int path_of_descriptor(int descriptor, char* path)
{
	char link[64];
	snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
	ssize_t length = readlink(link, path, PATH_MAX - 1);
	if (length < 0) return 0;
	path[length] = 0;
	return 1;
}

static int path_in(int at, const char* name, char* path)
{
	if (name[0] == '/') return snprintf(path, PATH_MAX, "%s", name) < PATH_MAX;
	if (at == AT_FDCWD ? !getcwd(path, PATH_MAX) : !path_of_descriptor(at, path)) return 0;
	size_t length = strlen(path);
	return snprintf(path + length, PATH_MAX - length, "/%s", name) < (int)(PATH_MAX - length);
}

enum { PROCEED, HALF, FAIL };

// Count a call; what is to become of it. takes_room: whether it fails on a full disk.
static int counted(const char* name, const char* path, int is_write, int takes_room)
{
	if (!armed || !below(path)) return PROCEED;
	++calls;
	char line[PATH_MAX + 64];
	int length = snprintf(line, sizeof line, "%ld %s %s\n", calls, name, path);
	syscall(SYS_write, log_file, line, (size_t)length);
	if (calls == stop_at) syscall(SYS_kill, getpid(), SIGTERM);
	if (action == DISK_FULL && calls >= target && takes_room) return is_write && calls == target ? HALF : FAIL;
	if (calls != target) return PROCEED;
	if (action == END_BEFORE || (action == END_HALFWAY && !is_write)) end_process();
	return action == END_HALFWAY ? HALF : PROCEED;
}

static int counted_at(const char* name, int at, const char* file, int takes_room)
{
	char path[PATH_MAX];
	return armed && path_in(at, file, path) ? counted(name, path, 0, takes_room) : PROCEED;
}

static int counted_descriptor(const char* name, int descriptor, int is_write, int takes_room)
{
	char path[PATH_MAX];
	return armed && path_of_descriptor(descriptor, path) ? counted(name, path, is_write, takes_room) : PROCEED;
}

#define NEXT(name) \
	static __typeof__(name)* next; \
	if (!next) next = (__typeof__(name)*)dlsym(RTLD_NEXT, #name)

#define FULL(result) return errno = ENOSPC, result

// ---- opening and making ----

#define OPEN(name, AT, FILE_NAME, PASS, ...) \
	int name(__VA_ARGS__, int flags, ...) \
	{ \
		NEXT(name); \
		va_list rest; \
		va_start(rest, flags); \
		mode_t mode = (flags & O_CREAT) || (flags & O_TMPFILE) == O_TMPFILE ? va_arg(rest, mode_t) : 0; \
		va_end(rest); \
		if (flags & (O_CREAT | O_TRUNC)) counted_at("open", AT, FILE_NAME, 0); \
		return next PASS; \
	}
OPEN(open, AT_FDCWD, path, (path, flags, mode), const char* path)
OPEN(open64, AT_FDCWD, path, (path, flags, mode), const char* path)
OPEN(openat, at, path, (at, path, flags, mode), int at, const char* path)
OPEN(openat64, at, path, (at, path, flags, mode), int at, const char* path)

#define FOPEN(name) \
	FILE* name(const char* path, const char* mode) \
	{ \
		NEXT(name); \
		if (mode[0] != 'r') counted_at("open", AT_FDCWD, path, 0); \
		return next(path, mode); \
	}
FOPEN(fopen)
FOPEN(fopen64)

// ---- writing ----

// ALL: the call itself, PART: the call for half of the bytes; after that half the process ends, or the disk is full.
#define WRITE(name, ALL, PART, ...) \
	ssize_t name(int descriptor, __VA_ARGS__) \
	{ \
		NEXT(name); \
		int what = counted_descriptor("write", descriptor, 1, 1); \
		if (what == PROCEED) return ALL; \
		ssize_t written = what == HALF ? PART : 0; \
		if (action == END_HALFWAY) end_process(); \
		if (written > 0) return written; \
		FULL(-1); \
	}
WRITE(write, next(descriptor, data, bytes), next(descriptor, data, bytes / 2), const void* data, size_t bytes)
WRITE(pwrite, next(descriptor, data, bytes, at), next(descriptor, data, bytes / 2, at), const void* data, size_t bytes, off_t at)
WRITE(pwrite64, next(descriptor, data, bytes, at), next(descriptor, data, bytes / 2, at), const void* data, size_t bytes, off64_t at)
WRITE(writev, next(descriptor, vectors, number), syscall(SYS_write, descriptor, vectors->iov_base, vectors->iov_len / 2), const struct iovec* vectors, int number)
// How Python copies a file.
WRITE(sendfile, next(descriptor, from, at, bytes), next(descriptor, from, at, bytes / 2), int from, off_t* at, size_t bytes)
WRITE(sendfile64, next(descriptor, from, at, bytes), next(descriptor, from, at, bytes / 2), int from, off64_t* at, size_t bytes)

#define OF_DESCRIPTOR(name, ROOM, PASS, ...) \
	int name(__VA_ARGS__) \
	{ \
		NEXT(name); \
		if (counted_descriptor(#name, descriptor, 0, ROOM) == FAIL) FULL(-1); \
		return next PASS; \
	}
OF_DESCRIPTOR(ftruncate, 0, (descriptor, length), int descriptor, off_t length)
OF_DESCRIPTOR(ftruncate64, 0, (descriptor, length), int descriptor, off64_t length)
OF_DESCRIPTOR(fsync, 0, (descriptor), int descriptor)
OF_DESCRIPTOR(fdatasync, 0, (descriptor), int descriptor)
OF_DESCRIPTOR(fchmod, 0, (descriptor, mode), int descriptor, mode_t mode)

// ---- names ----

// Renamed and linked files are counted by the new name.
#define OF_NAME(name, AS, ROOM, AT, PASS, ...) \
	int name(__VA_ARGS__) \
	{ \
		NEXT(name); \
		if (counted_at(AS, AT, path, ROOM) == FAIL) FULL(-1); \
		return next PASS; \
	}
OF_NAME(mkdir, "mkdir", 1, AT_FDCWD, (path, mode), const char* path, mode_t mode)
OF_NAME(mkdirat, "mkdir", 1, at, (at, path, mode), int at, const char* path, mode_t mode)
OF_NAME(chmod, "chmod", 0, AT_FDCWD, (path, mode), const char* path, mode_t mode)
OF_NAME(fchmodat, "fchmodat", 0, at, (at, path, mode, flags), int at, const char* path, mode_t mode, int flags)
OF_NAME(truncate, "truncate", 0, AT_FDCWD, (path, length), const char* path, off_t length)
OF_NAME(unlink, "unlink", 0, AT_FDCWD, (path), const char* path)
OF_NAME(unlinkat, "unlinkat", 0, at, (at, path, flags), int at, const char* path, int flags)
OF_NAME(rmdir, "rmdir", 0, AT_FDCWD, (path), const char* path)
OF_NAME(rename, "rename", 0, AT_FDCWD, (from, path), const char* from, const char* path)
OF_NAME(renameat, "rename", 0, at, (from_at, from, at, path), int from_at, const char* from, int at, const char* path)
OF_NAME(link, "link", 0, AT_FDCWD, (from, path), const char* from, const char* path)
OF_NAME(linkat, "link", 0, at, (from_at, from, at, path, flags), int from_at, const char* from, int at, const char* path, int flags)
