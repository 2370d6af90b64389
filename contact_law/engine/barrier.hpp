// Where the threads of a step wait for each other. Steps take tens of microseconds, so it spins; but not for long, because on a machine that does
// other things too the thread that is waited for may need this one's processor: then it sleeps (futex).
#pragma once
#include <atomic>
#include <climits>
#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace contact_law {

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

} // namespace contact_law
