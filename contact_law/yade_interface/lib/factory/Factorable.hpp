// What YADE makes by class name.
#pragma once
#include <lib/base/Math.hpp>
#include <boost/enable_shared_from_this.hpp>
#include <boost/shared_ptr.hpp>
#include <string>

namespace yade {

class Factorable : public boost::enable_shared_from_this<Factorable> {
public:
	Factorable() {}
	virtual ~Factorable();
	virtual std::string getBaseClassName(unsigned int = 0) const;
	virtual int getBaseClassNumber() const;
	virtual std::string getClassName() const;
};
static_assert(sizeof(Factorable) == 24, "Factorable");

} // namespace yade
