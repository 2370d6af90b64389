// How threads share out the domains of a step, and where they wait for each other.
#pragma once
#include <atomic>
#include <climits>
#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>
#include <vector>

namespace contact_law {

/* Steps take tens of microseconds, so threads that wait spin; but not for long, because on a machine that does other things too the thread
 * that is waited for may need this one's processor: then they sleep (futex). */
class Barrier {
public:
	void wait(int threads) // of as many
	{
		if (threads == 1) return;
		const int round = rounds.load(std::memory_order_acquire);
		if (arrived.fetch_add(1, std::memory_order_acq_rel) == threads - 1) {
			arrived.store(0, std::memory_order_relaxed);
			rounds.store(round + 1, std::memory_order_seq_cst);
			if (sleepers.load(std::memory_order_seq_cst) > 0)
				syscall(SYS_futex, &rounds, FUTEX_WAKE_PRIVATE, INT_MAX, nullptr, nullptr, 0);
			return;
		}
		for (int spins = 0; spins < 2000; ++spins) {
			if (rounds.load(std::memory_order_acquire) != round) return;
			pause();
		}
		sleepers.fetch_add(1, std::memory_order_seq_cst);
		while (rounds.load(std::memory_order_seq_cst) == round)
			syscall(SYS_futex, &rounds, FUTEX_WAIT_PRIVATE, round, nullptr, nullptr, 0);
		sleepers.fetch_sub(1, std::memory_order_seq_cst);
	}

private:
	// Tells the processor that the thread spins.
	static void pause()
	{
#if defined __x86_64__
		__builtin_ia32_pause();
#elif defined __aarch64__
		asm volatile("yield");
#endif
	}

	alignas(64) std::atomic<int> arrived { 0 };
	alignas(64) std::atomic<int> rounds { 0 };
	alignas(64) std::atomic<int> sleepers { 0 };
};

/* Between two barriers each domain is taken once: by its own thread, or by one that has done its own already. Times of domains differ from
 * step to step (neighbours searched for, slips), and a thread may be held up by other work on the machine. Who takes a domain changes
 * nothing in it. */
struct alignas(64) Share {             // of a domain
	std::atomic<long> taken { 0 }; // how often so far
};

class Shares {
public:
	// One of several threads that share out the same domains. Every thread calls each() as often, with a barrier between two calls.
	Shares(std::vector<Share>& all_, int thread_, int threads_)
	        : thread(thread_)
	        , threads(threads_)
	        , all(all_)
	{
	}

	template <class What> void each(What&& what) // what(domain)
	{
		const int count = int(all.size());
		for (int other = 0; other < threads; ++other)
			for (int d = (thread + other) % threads; d < count; d += threads)
				if (take(d)) what(d);
		++calls;
	}

	const int thread, threads;

private:
	bool take(int d)
	{
		// Most domains are taken already; to read that leaves the line with the other threads, where an exchange that fails
		// fetches it.
		long before = calls;
		return all[d].taken.load(std::memory_order_relaxed) == before
		        && all[d].taken.compare_exchange_strong(before, calls + 1, std::memory_order_relaxed);
	}

	std::vector<Share>& all;
	long calls = 0;
};

} // namespace contact_law
