#define BOOST_TEST_MODULE arm3r
#include <boost/test/included/unit_test.hpp>
