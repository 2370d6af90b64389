// Classes that functors are chosen by carry a number each. The order of the virtual functions is that of YADE's tables.
#pragma once
#include <boost/scoped_ptr.hpp>

namespace yade {

class Indexable {
public:
	virtual void incrementMaxCurrentlyUsedClassIndexOfKin() = 0;
	virtual int& modifyClassIndex() = 0;
	Indexable() {}
	virtual ~Indexable() {}
	virtual const int& getClassIndex() const = 0;
	virtual const int& getBaseClassIndex(int depth) const = 0;
	virtual const int& getMaxCurrentlyUsedClassIndexOfKin() const = 0;

protected:
	void createIndex(); // exported by libpkg_common; every class below the topmost one calls it in its own constructor
};

} // namespace yade

// The topmost class of a kin: all five are exported by YADE's libraries. (Declared here in the order in which they stand in the main table.)
#define REGISTER_INDEX_COUNTER(SomeClass)                                                                                                  \
public:                                                                                                                                    \
	int& modifyClassIndex() override;                                                                                                  \
	const int& getClassIndex() const override;                                                                                         \
	const int& getBaseClassIndex(int) const override;                                                                                  \
	const int& getMaxCurrentlyUsedClassIndexOfKin() const override;                                                                    \
	void incrementMaxCurrentlyUsedClassIndexOfKin() override

// A class of the plugin.
#define REGISTER_CLASS_INDEX(SomeClass, BaseClass)                                                                                         \
private:                                                                                                                                   \
	static int& modifyClassIndexStatic()                                                                                               \
	{                                                                                                                                  \
		static int index = -1;                                                                                                     \
		return index;                                                                                                              \
	}                                                                                                                                  \
                                                                                                                                           \
public:                                                                                                                                    \
	static const int& getClassIndexStatic() { return modifyClassIndexStatic(); }                                                       \
	int& modifyClassIndex() override { return modifyClassIndexStatic(); }                                                              \
	const int& getClassIndex() const override { return modifyClassIndexStatic(); }                                                     \
	const int& getBaseClassIndex(int depth) const override                                                                             \
	{                                                                                                                                  \
		static const boost::scoped_ptr<BaseClass> base(new BaseClass);                                                             \
		return depth == 1 ? base->getClassIndex() : base->getBaseClassIndex(depth - 1);                                            \
	}
