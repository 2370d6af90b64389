/* One source, two back ends: what a block of threads does together, as loops with barriers between them. nvcc gives each thread of a block
 * its share of a loop; g++ lets one thread do them all, one after another. Results do not depend on the number of threads, but for the
 * rounding of sums. */
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#ifdef __CUDACC__
#define GPU __device__
#define RARE __noinline__ // out of the way of what every step does, whose registers it would take
#define EACH(i, n) for (int i = int(threadIdx.x), i##End = (n); i < i##End; i += int(blockDim.x))
#define BARRIER() __syncthreads()
#define FIRST if (threadIdx.x == 0)
// The kernel's free functions are all inline, and run on both sides; but the table of channels is the host's.
#define inline __host__ __device__ inline
#include "../kernel/numbers.hpp"
#undef inline
#include "../kernel/energy_channels.hpp"
#define inline __host__ __device__ inline
#include "../kernel/bond.hpp"
#undef inline
#else
#define GPU
#define RARE
#define EACH(i, n) for (int i = 0, i##End = (n); i < i##End; ++i)
#define BARRIER()
#define FIRST
#include "../kernel/bond.hpp"
#endif

namespace contact_law {
namespace gpu {

#ifdef __CUDACC__
#ifndef THREADS
#define THREADS 256
#define BLOCKS 2
#endif
	constexpr int mostThreads = THREADS, blocksSideBySide = BLOCKS; // of a block; on a multiprocessor
	GPU int thread() { return int(threadIdx.x); }
	GPU int threads() { return int(blockDim.x); }
	GPU int takeNext(int& count) { return atomicAdd(&count, 1); }
#else
	constexpr int mostThreads = 1;
	inline int thread() { return 0; }
	inline int threads() { return 1; }
	inline int takeNext(int& count) { return count++; }
#endif

	// What addUp() needs of the block's memory.
	struct Ranks {
		int of[mostThreads], total;
	};

	// Calls take(k, before) for each k of [0, n) whose count(k) is not 0, with the sum of the counts before it. Returns the sum of all.
	template <class Count, class Take> GPU int addUp(Ranks& ranks, int n, const Count& count, const Take& take)
	{
		const int each = (n + threads() - 1) / threads();
		const int from = thread() * each < n ? thread() * each : n, to = from + each < n ? from + each : n;
		int own = 0;
		for (int k = from; k < to; ++k)
			own += count(k);
		ranks.of[thread()] = own;
		BARRIER();
		FIRST
		{
			int sum = 0;
			for (int t = 0; t < threads(); ++t) {
				const int before = sum;
				sum += ranks.of[t];
				ranks.of[t] = before;
			}
			ranks.total = sum;
		}
		BARRIER();
		int before = ranks.of[thread()];
		for (int k = from; k < to; ++k) {
			const int here = count(k);
			if (here) take(k, before);
			before += here;
		}
		const int total = ranks.total;
		BARRIER();
		return total;
	}

} // namespace gpu
} // namespace contact_law
