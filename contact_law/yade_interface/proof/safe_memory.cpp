#include "safe_memory.hpp"
#include <algorithm>
#include <climits>
#include <dlfcn.h>
#include <fcntl.h>
#include <unistd.h>

namespace contact_law {
namespace proof {

	// The kernel says which addresses are there: what is not cannot be written into a pipe. (process_vm_readv would do it at once, but emulators and
	// some containers lack it.)
	bool readSafely(const void* from, void* to, size_t bytes)
	{
		int pipe[2];
		if (pipe2(pipe, O_CLOEXEC)) return false;
		bool all = true;
		for (size_t done = 0, part; all && done < bytes; done += part) {
			part = std::min<size_t>(bytes - done, PIPE_BUF); // as much as a pipe takes as a whole
			all = write(pipe[1], static_cast<const char*>(from) + done, part) == ssize_t(part)
			        && read(pipe[0], static_cast<char*>(to) + done, part) == ssize_t(part);
		}
		close(pipe[0]), close(pipe[1]);
		return all;
	}

	namespace {
		template <class T> T valueAt(const char* from)
		{
			T value {};
			return readSafely(from, &value, sizeof value) ? value : T {};
		}
		const char* table(const void* object, size_t offset)
		{
			return valueAt<const char*>(static_cast<const char*>(object) + offset);
		}
	}

	std::string classOf(const void* object)
	{
		const char* typeInformation = valueAt<const char*>(table(object, 0) - sizeof(void*));
		const char* name = valueAt<const char*>(typeInformation + sizeof(void*));
		std::string result;
		for (char c; readSafely(name + result.size(), &c, 1) && c && result.size() < 200;)
			result += c;
		return result.empty() ? "?" : result;
	}

	std::string functionInSlot(const void* object, size_t offset, int slot)
	{
		const void* function = valueAt<const void*>(table(object, offset) + slot * long(sizeof(void*)));
		Dl_info found;
		return function && dladdr(function, &found) && found.dli_sname ? found.dli_sname : "?";
	}

	std::ptrdiff_t offsetToTop(const void* object, size_t offset)
	{
		return valueAt<std::ptrdiff_t>(table(object, offset) - 2 * sizeof(void*));
	}

} // namespace proof
} // namespace contact_law
