// A person's push on Gazebo's topic ~/tandemlift/push (gazebo.msgs.GzString), in simulated time:
//   force FX FY FZ [point X Y Z] [duration S]   N in world axes, m in body axes from the vehicle's centre of mass, s
//   off                                         ends all pushes

#pragma once

#include <sstream>
#include <stdexcept>
#include <string>

#include <ignition/math/Vector3.hh>

namespace tandemlift {

using ignition::math::Vector3d;

constexpr double LARGEST_PUSH = 1e4;     // N
constexpr double LONGEST_PUSH = 3600.0;  // s

// A wrench that is held for a while.
struct Push {
    Vector3d force;   // N, world axes
    Vector3d moment;  // N m, world axes, beside that of the force
    Vector3d point;   // m, body axes, from the vehicle's centre of mass
    double left;      // s
};

// The push that a text says; throws std::invalid_argument with what is wrong.
inline Push ReadPush(const std::string& text) {
    Push push{Vector3d::Zero, Vector3d::Zero, Vector3d::Zero, 1.0};
    std::istringstream words(text);
    bool forced = false;
    for (std::string word; words >> word;) {
        double x = 0.0, y = 0.0, z = 0.0;
        if (word == "force" && words >> x >> y >> z) {
            push.force.Set(x, y, z);
            forced = true;
        } else if (word == "point" && words >> x >> y >> z) {
            push.point.Set(x, y, z);
        } else if (!(word == "duration" && words >> push.left)) {
            throw std::invalid_argument("cannot read '" + word + "' and what follows");
        }
    }
    if (!forced) throw std::invalid_argument("no force is given");
    if (!(push.force.Length() <= LARGEST_PUSH)) throw std::invalid_argument("the force must be at most 10000 N");
    if (!(push.point.Length() <= 1e3)) throw std::invalid_argument("the point must be within 1000 m");
    if (!(push.left > 0.0 && push.left <= LONGEST_PUSH))
        throw std::invalid_argument("the duration must be more than 0 and at most 3600 s");
    return push;
}

}  // namespace tandemlift
