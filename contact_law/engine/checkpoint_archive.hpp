/* The two directions of a checkpoint: one list of numbers, taken through either archive, is saved or restored (as in Boost.Serialization).
 * Numbers are doubles in a row, whole ones (below 2^53) and flags among them; the last is a sum of all others' bits. */
#pragma once
#include "shared_state.hpp"
#include <array>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

namespace contact_law {

// Of the bits of all numbers before the last (FNV-1a, by words); whole, and below 2^53.
inline double sumOfBits(const std::vector<double>& numbers, std::size_t count)
{
	std::uint64_t sum = 14695981039346656037u;
	for (std::size_t k = 0; k < count; ++k) {
		std::uint64_t bits;
		std::memcpy(&bits, &numbers[k], sizeof bits);
		sum = (sum ^ bits) * 1099511628211u;
	}
	return double(sum >> 11);
}
inline std::vector<double> sealed(std::vector<double> numbers)
{
	numbers.push_back(sumOfBits(numbers, numbers.size()));
	return numbers;
}
// Before any of the numbers is an index.
inline void requireSealed(const std::vector<double>& numbers)
{
	if (numbers.empty() || numbers.back() != sumOfBits(numbers, numbers.size() - 1))
		throw std::invalid_argument("the checkpoint of the grains is damaged: it must be as O.save wrote it");
}

class SavingArchive {
public:
	static constexpr bool restoring = false;
	std::vector<double> numbers;

	void header(double magic, int format) { numbers.insert(numbers.end(), { magic, double(format) }); }
	template <class T> void number(T& value) { numbers.push_back(double(value)); }
	// One that must be the same when the run is restored; its name and, if there is one, a number stand in the refusal.
	template <class T> void same(const T& value, const char*, const char* = "", int = 0) { numbers.push_back(double(value)); }
};

class RestoringArchive {
public:
	static constexpr bool restoring = true;

	explicit RestoringArchive(const std::vector<double>& from_)
	        : from(from_)
	{
	}
	void header(double magic, int format)
	{
		const bool known = next() == magic;
		const double saved = known ? next() : 1; // the first format had no header
		if (saved != format)
			throw std::invalid_argument("the checkpoint of the grains is of format " + textOf(saved)
			        + ", which another version wrote: it must be " + textOf(format));
		requireSealed(from);
	}
	template <class T> void number(T& value) { value = T(next()); }
	template <class T> void same(const T& value, const char* name, const char* of = "", int number = 0)
	{
		const double saved = next();
		if (saved != double(value))
			throw std::invalid_argument(std::string(name) + of + (*of ? std::to_string(number) : "")
			        + " is another than in the checkpoint: it must be " + textOf(saved));
	}

private:
	double next()
	{
		if (at == from.size())
			throw std::invalid_argument("the checkpoint of the grains is cut off: it must be whole, as O.save wrote it");
		return from[at++];
	}
	const std::vector<double>& from;
	std::size_t at = 0;
};

// ---- what checkpoints are made of, each listed once ----

template <class Archive, class... Numbers> void transferNumbers(Archive& archive, Numbers&... numbers) { (archive.number(numbers), ...); }

template <class Archive> void transfer(Archive& archive, Vec3<double>& v) { transferNumbers(archive, v.x, v.y, v.z); }
template <class Archive> void transfer(Archive& archive, Grain& g)
{
	transferNumbers(archive, g.x, g.y, g.z, g.vx, g.vy, g.vz, g.wx, g.wy, g.wz, g.fx, g.fy, g.fz, g.tx, g.ty, g.tz);
}
template <class Archive> void transfer(Archive& archive, ContactHistory<double>& h)
{
	transfer(archive, h.pointers.n1);
	transfer(archive, h.pointers.n2);
	archive.number(h.twist);
}
template <class Archive> void transfer(Archive& archive, Dissipation& d)
{
	for (const auto member : lostMembers<double>)
		archive.number(d.*member);
}
template <class Archive> void transfer(Archive& archive, PeriodicCell& cell)
{
	for (Vec3<double>* v : { &cell.size, &cell.inverse, &cell.rate })
		transfer(archive, *v);
}
template <class Archive> void transfer(Archive& archive, BoundaryWork& work)
{
	archive.number(work.done);
	transfer(archive, work.kicks);
	transfer(archive, work.early);
}

} // namespace contact_law
