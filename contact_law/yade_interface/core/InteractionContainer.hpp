// All interactions of a scene, real and potential.
#pragma once
#include <core/BodyContainer.hpp>
#include <core/Interaction.hpp>
#include <vector>

namespace yade {

class InteractionContainer : public Serializable {
public:
	using ContainerT = std::vector<shared_ptr<Interaction>>;
	using iterator = ContainerT::iterator;

	~InteractionContainer() override;
	YADE_INTERFACE_OVERRIDES_(InteractionContainer)

	[[gnu::always_inline]] iterator begin() { return linIntrs.begin(); }
	[[gnu::always_inline]] iterator end() { return linIntrs.end(); }
	[[gnu::always_inline]] size_t size() { return currSize; } // not const in YADE either
	[[gnu::always_inline]] const shared_ptr<Interaction>& operator[](size_t i) const { return linIntrs[i]; }

	const shared_ptr<Interaction>& find(Body::id_t id1, Body::id_t id2);
	bool insert(const shared_ptr<Interaction>&);
	bool erase(Body::id_t id1, Body::id_t id2, int linPos);
	void requestErase(const shared_ptr<Interaction>&);
	void eraseNonReal();
	void clear();

private:
	InteractionContainer(); // made by YADE only
	ContainerT linIntrs, sortedIntrs;
	const std::vector<shared_ptr<Body>>* bodies;
	size_t currSize;
	shared_ptr<Interaction> empty;

public:
	std::vector<shared_ptr<Interaction>> interaction; // filled while saving and loading
	bool dirty;

private:
	declare::Mutex drawloopmutex;

public:
	bool serializeSorted;
	long iterColliderLastRun;
};
static_assert(sizeof(InteractionContainer) == 152 + declare::mutex, "InteractionContainer");
YADE_INTERFACE_AT_(InteractionContainer, interaction, 104) // right behind linIntrs ... empty
YADE_INTERFACE_AT_(InteractionContainer, dirty, 128)
YADE_INTERFACE_AT_(InteractionContainer, serializeSorted, 136 + declare::mutex)
YADE_INTERFACE_AT_(InteractionContainer, iterColliderLastRun, 144 + declare::mutex)

} // namespace yade
