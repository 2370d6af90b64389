// All bodies of a scene, by id. Erased ones leave an empty pointer, which operator[] shows and the iterator skips.
#pragma once
#include <core/Body.hpp>
#include <declare/subdomain.hpp>
#include <boost/iterator/filter_iterator.hpp>
#include <vector>

namespace yade {

class BodyContainer : public Serializable {
public:
	using ContainerT = std::vector<shared_ptr<Body>>;
	struct IsThere {
		bool operator()(const shared_ptr<Body>& body) const { return bool(body); }
	};
	using iterator = boost::filter_iterator<IsThere, ContainerT::iterator>;

	~BodyContainer() override;
	YADE_INTERFACE_OVERRIDES_(BodyContainer)

	// Always inline: libyade exports functions of these names, whose iterator is another type.
	[[gnu::always_inline]] iterator begin() { return iterator(IsThere(), body.begin(), body.end()); }
	[[gnu::always_inline]] iterator end() { return iterator(IsThere(), body.end(), body.end()); }
	[[gnu::always_inline]] size_t size() const { return body.size(); }
	[[gnu::always_inline]] shared_ptr<Body>& operator[](unsigned int id) { return body[id]; }
	[[gnu::always_inline]] const shared_ptr<Body>& operator[](unsigned int id) const { return body[id]; }
	[[gnu::always_inline]] bool exists(Body::id_t id) const { return id >= 0 && size_t(id) < body.size() && bool(body[size_t(id)]); }

	Body::id_t insert(shared_ptr<Body>);

private:
	BodyContainer(); // made by YADE only
	ContainerT body;

public:
	bool dirty, checkedByCollider;
	std::vector<int> insertedBodies, erasedBodies, realBodies;
	bool useRedirection, enableRedirection;

private:
#ifdef YADE_MPI
	std::vector<int> subdomainBodies;
#endif
	declare::Mutex drawloopmutex;
};
static_assert(sizeof(BodyContainer) == 136 + declare::mutex + declare::subdomain, "BodyContainer");
YADE_INTERFACE_AT_(BodyContainer, dirty, 48) // right behind body
YADE_INTERFACE_AT_(BodyContainer, insertedBodies, 56)
YADE_INTERFACE_AT_(BodyContainer, useRedirection, 128)

} // namespace yade
