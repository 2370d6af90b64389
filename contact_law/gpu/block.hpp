/* One source, two back ends: what a team of threads does together, as loops with barriers between them. A team is a block of a GPU, or with
 * -DWHOLE all of its blocks; for g++ it is one thread, or with -DWHOLE those of OpenMP. Results do not depend on the number of threads, but
 * for the rounding of sums. */
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
#ifdef WHOLE
#include <cooperative_groups.h>
#endif
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
#include <omp.h>
#include "../kernel/bond.hpp"
#endif
#define EACH(i, n) for (int i = thread(), i##End = (n); i < i##End; i += threads())
#define FIRST if (thread() == 0)

namespace contact_law {
namespace gpu {

#ifdef __CUDACC__
#ifndef THREADS
#define THREADS 256
#define BLOCKS 2
#endif
	constexpr int threadsOfGroup = THREADS, blocksSideBySide = BLOCKS; // a group is a block; side by side on a multiprocessor
#ifdef WHOLE
	constexpr int mostGroups = 160 * BLOCKS; // of a device with so many multiprocessors
	GPU int thread() { return int(blockIdx.x * blockDim.x + threadIdx.x); }
	GPU int threads() { return int(gridDim.x * blockDim.x); }
	GPU void barrier() { cooperative_groups::this_grid().sync(); }
#else
	constexpr int mostGroups = 1;
	GPU int thread() { return int(threadIdx.x); }
	GPU int threads() { return int(blockDim.x); }
	GPU void barrier() { __syncthreads(); }
#endif
	GPU int takeNext(int& count) { return atomicAdd(&count, 1); }
#elif defined(WHOLE)
	constexpr int threadsOfGroup = 2, mostGroups = 64;
	inline int thread() { return omp_get_thread_num(); }
	inline int threads() { return omp_get_num_threads(); }
	inline void barrier()
	{
#pragma omp barrier
	}
	inline int takeNext(int& count) { return __atomic_fetch_add(&count, 1, __ATOMIC_RELAXED); }
#else
	constexpr int threadsOfGroup = 1, mostGroups = 1;
	inline int thread() { return 0; }
	inline int threads() { return 1; }
	inline void barrier() {}
	inline int takeNext(int& count) { return count++; }
#endif
	constexpr int mostThreads = threadsOfGroup * mostGroups;
	GPU inline int group() { return thread() / threadsOfGroup; }
	GPU inline int groups() { return (threads() + threadsOfGroup - 1) / threadsOfGroup; }
	GPU inline int endOfGroup() { return thread() + threadsOfGroup < threads() ? thread() + threadsOfGroup : threads(); }
#define FIRST_OF_GROUP if (thread() % threadsOfGroup == 0)

	// What addUp() needs of the team's memory.
	struct Ranks {
		int of[mostThreads], ofGroup[mostGroups], total;
	};

	// Of n numbers those before each, in their place; returns the sum of all.
	GPU inline int addUpInPlace(int* numbers, int n)
	{
		int sum = 0;
		for (int k = 0; k < n; ++k) {
			const int before = sum;
			sum += numbers[k];
			numbers[k] = before;
		}
		return sum;
	}

	// Calls take(k, before) for each k of [0, n) whose count(k) is not 0, with the sum of the counts before it. Returns the sum of all.
	template <class Count, class Take> GPU int addUp(Ranks& ranks, int n, const Count& count, const Take& take)
	{
		const int each = (n + threads() - 1) / threads();
		const int from = thread() * each < n ? thread() * each : n, to = from + each < n ? from + each : n;
		int own = 0;
		for (int k = from; k < to; ++k)
			own += count(k);
		ranks.of[thread()] = own;
		barrier();
		FIRST_OF_GROUP { ranks.ofGroup[group()] = addUpInPlace(ranks.of + thread(), endOfGroup() - thread()); }
		if (mostGroups > 1) barrier();
		FIRST { ranks.total = addUpInPlace(ranks.ofGroup, groups()); }
		barrier();
		int before = ranks.ofGroup[group()] + ranks.of[thread()];
		for (int k = from; k < to; ++k) {
			const int here = count(k);
			if (here) take(k, before);
			before += here;
		}
		const int total = ranks.total;
		barrier();
		return total;
	}

} // namespace gpu
} // namespace contact_law
