/* How threads share out the domains. Between two barriers each domain is taken once: by its own thread, or by one that has done its own already. Times of domains differ from
 * step to step (neighbours searched for, slips), and a thread may be held up by other work on the machine. Who takes a domain changes nothing in it. */
#pragma once
#include <atomic>
#include <vector>

namespace contact_law {

struct alignas(64) Share {             // a domain
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
		// Most domains are taken already; to read that leaves the line with the other threads, where an exchange that fails fetches it.
		long before = calls;
		return all[d].taken.load(std::memory_order_relaxed) == before
		        && all[d].taken.compare_exchange_strong(before, calls + 1, std::memory_order_relaxed);
	}

	std::vector<Share>& all;
	long calls = 0;
};

} // namespace contact_law
