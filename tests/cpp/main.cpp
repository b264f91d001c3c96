#define BOOST_TEST_MODULE arm3r
#include <boost/test/unit_test.hpp>
