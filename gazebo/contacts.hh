// What touches the vehicle: the contacts of its collision shapes over a step, as the physics engine has solved them.
//
// A part is told by the names of its shape and link: `rotor_J` of quadrotor_I, `guard...` of quadrotor_I, `beam...` of
// the payload; any other shape, such as a foot, is of no part. Shapes of the model `floor` are the floor, all others
// beside the vehicle's are walls.
//
// Touches, of N quadrotors: for the floor, then for walls: of each of the 4 N rotors, the N guards and the beam the
// normal force of its contacts [N], and where the strongest of them is (3) [m, world]; zeros where it does not touch.

#pragma once

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <gazebo/physics/physics.hh>

#include "vehicle.hh"

namespace tandemlift {

class Contacts {
  public:
    void Load(const gazebo::physics::ModelPtr& model, std::size_t count) {
        manager_ = model->GetWorld()->Physics()->GetContactManager();
        manager_->SetNeverDropContacts(true);  // or there are none without a subscriber
        parts_ = 5 * count + 1;
        for (const auto& link : model->GetLinks())
            for (const auto& shape : link->GetCollisions())
                places_[shape.get()] = PartOf(link->GetName(), shape->GetName(), count);
    }

    std::size_t Count() const { return 8 * parts_; }  // of numbers of Touches

    // The Touches of the step just taken, and the force of all contacts on the vehicle [N, world].
    std::vector<double> Read(Vector3d& sum) const {
        std::vector<double> touches(Count());
        std::vector<double> strongest(2 * parts_);
        for (unsigned int k = 0; k < manager_->GetContactCount(); ++k) {
            const auto& contact = *manager_->GetContact(k);
            const auto one = places_.find(contact.collision1);
            const auto mine = one != places_.end() ? one : places_.find(contact.collision2);
            if (mine == places_.end()) continue;
            const auto& other = mine == one ? *contact.collision2 : *contact.collision1;
            const Quaterniond turn = mine->first->GetLink()->WorldPose().Rot();  // forces are in the axes of the link
            const std::size_t row = mine->second + (other.GetModel()->GetName() == "floor" ? 0 : parts_);
            for (int j = 0; j < contact.count; ++j) {
                const auto& wrench = contact.wrench[j];
                const Vector3d force = turn * (mine == one ? wrench.body1Force : wrench.body2Force);
                sum += force;
                if (mine->second < 0) continue;
                const double normal = std::abs(force.Dot(contact.normals[j]));
                touches[4 * row] += normal;
                if (normal <= strongest[row]) continue;
                strongest[row] = normal;
                for (std::size_t axis = 0; axis < 3; ++axis) touches[4 * row + 1 + axis] = contact.positions[j][axis];
            }
        }
        return touches;
    }

  private:
    // The number of a part among all; -1 for a shape of none.
    static int PartOf(const std::string& link, const std::string& shape, std::size_t count) {
        const int N = static_cast<int>(count), i = link.rfind("quadrotor_", 0) == 0 ? std::stoi(link.substr(10)) - 1 : -1;
        if (link == "payload") return shape.rfind("beam", 0) == 0 ? 5 * N : -1;
        if (i < 0 || i >= N) return -1;
        if (shape.rfind("rotor_", 0) == 0) return 4 * i + std::stoi(shape.substr(6)) - 1;
        return shape.rfind("guard", 0) == 0 ? 4 * N + i : -1;
    }

    gazebo::physics::ContactManager* manager_ = nullptr;
    std::size_t parts_ = 0;
    std::map<const gazebo::physics::Collision*, int> places_;
};

}  // namespace tandemlift
