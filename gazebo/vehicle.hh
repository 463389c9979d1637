// The vehicle in Gazebo 11: forces in, motion and joint wrenches out.
//
// The model has the links `payload` and `quadrotor_1` ... `quadrotor_N`, and a fixed joint `joint_i` from the payload
// (parent) to each quadrotor (child). The origin of `payload` is that of the mission's positions, the middle of a beam.
//
// A State is 13 numbers: position and velocity [world] of the vehicle's centre of mass, quaternion w, x, y, z, rates
// [rad/s, body]. Gazebo's step is v' = v + h a, then x' = x + h v': its positions are half a step ahead of its
// velocities. In a State they are taken back by h v / 2, to the time of the velocities, and where the vehicle is placed
// they are put ahead by as much. What is told is then of second order in h, not of first.

#pragma once

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <gazebo/common/common.hh>
#include <gazebo/physics/physics.hh>

#include "push.hh"

namespace tandemlift {

using ignition::math::Pose3d;
using ignition::math::Quaterniond;

inline bool Finite(const std::vector<double>& values) {
    for (double value : values)
        if (!std::isfinite(value)) return false;
    return true;
}

inline Vector3d Three(const std::vector<double>& values, std::size_t at, std::size_t apart = 1) {
    return {values[at], values[at + apart], values[at + 2 * apart]};
}

inline void Put(std::vector<double>& values, const Vector3d& v) { values.insert(values.end(), {v.X(), v.Y(), v.Z()}); }

// The rotation by a vector of an angle [rad] about its direction, world axes.
inline Quaterniond Turn(const Vector3d& angle) {
    const double size = angle.Length();
    return size > 0.0 ? Quaterniond(angle / size, size) : Quaterniond::Identity;
}

class Vehicle {
  public:
    // Throws std::runtime_error with what is missing in the model.
    void Load(const gazebo::physics::ModelPtr& model) {
        model_ = model;
        payload_ = Link("payload");
        for (int i = 1; model->GetLink("quadrotor_" + std::to_string(i)); ++i) {
            quadrotors_.push_back(Link("quadrotor_" + std::to_string(i)));
            const auto joint = model->GetJoint("joint_" + std::to_string(i));
            if (!joint || joint->GetParent() != payload_ || joint->GetChild() != quadrotors_.back())
                throw std::runtime_error("no joint_" + std::to_string(i) + " from payload to its quadrotor");
            joint->SetProvideFeedback(true);
            joints_.push_back(joint);
        }
        if (quadrotors_.empty()) throw std::runtime_error("no link quadrotor_1");
        links_.push_back(payload_);
        links_.insert(links_.end(), quadrotors_.begin(), quadrotors_.end());
        Vector3d moment;
        for (const auto& link : links_) {
            offsets_.push_back(payload_->WorldPose().Inverse() * link->WorldPose());
            const auto& pose = offsets_.back();
            moment += link->GetInertial()->Mass() * (pose.Pos() + pose.Rot() * link->GetInertial()->CoG());
            mass_ += link->GetInertial()->Mass();
        }
        center_ = moment / mass_;
    }

    std::size_t Count() const { return quadrotors_.size(); }
    double Mass() const { return mass_; }
    const Vector3d& Center() const { return center_; }  // of mass, in the payload's frame [m]
    const std::vector<gazebo::physics::LinkPtr>& Links() const { return links_; }

    // Put the vehicle into a State, as one rigid body, where a step takes some seconds.
    void Place(const std::vector<double>& values, std::size_t at, double step) {
        const Vector3d velocity = Three(values, at + 3), position = Three(values, at) + 0.5 * step * velocity;
        Quaterniond attitude(values[at + 6], values[at + 7], values[at + 8], values[at + 9]);
        attitude.Normalize();
        const Vector3d rates = attitude * Three(values, at + 10);
        attitude = Turn(0.5 * step * rates) * attitude;
        model_->ResetPhysicsStates();
        const Pose3d base(position - attitude * center_, attitude);
        for (std::size_t i = 0; i < links_.size(); ++i) {
            const Pose3d pose = base * offsets_[i];
            links_[i]->SetWorldPose(pose);
            const Vector3d arm = pose.Pos() + pose.Rot() * links_[i]->GetInertial()->CoG() - position;
            links_[i]->SetLinearVel(velocity + rates.Cross(arm));  // of the link's centre of mass
            links_[i]->SetAngularVel(rates);
        }
    }

    // Begin a step: no force acts, and what its accelerations are measured from is kept.
    void Begin() {
        applied_ = Vector3d::Zero;
        before_ = payload_->WorldPose().Rot();
        payload_velocity_ = payload_->WorldLinearVel();
        velocities_.clear();
        for (const auto& link : links_) velocities_.push_back(link->WorldCoGLinearVel());
    }

    // Thrust [N] along body z and moment [N m, body] of quadrotor i's rotors.
    void Lift(std::size_t i, double thrust, const Vector3d& moment) {
        quadrotors_[i]->AddRelativeForce({0.0, 0.0, thrust});
        quadrotors_[i]->AddRelativeTorque(moment);
        applied_ += quadrotors_[i]->WorldPose().Rot() * Vector3d(0.0, 0.0, thrust);
    }

    // Force [N, world] at quadrotor i's centre of mass, and moment [N m, body].
    void Load(std::size_t i, const Vector3d& force, const Vector3d& moment) {
        quadrotors_[i]->AddForce(force);
        quadrotors_[i]->AddRelativeTorque(moment);
        applied_ += force;
    }

    // Force [N, world] at a point of the payload [m, from its origin], and moment [N m, body].
    void Load(const Vector3d& force, const Vector3d& moment, const Vector3d& point) {
        payload_->AddForce(force);
        payload_->AddRelativeTorque(
            moment + (point - payload_->GetInertial()->CoG()).Cross(before_.RotateVectorReverse(force)));
        applied_ += force;
    }

    // A push at a point from the centre of mass; the moment that it makes about there [N m, body].
    Vector3d Pushed(const Push& push) {
        const Vector3d moment = before_.RotateVectorReverse(push.moment);
        Load(push.force, moment, center_ + push.point);
        return moment + push.point.Cross(before_.RotateVectorReverse(push.force));
    }

    // Append the State, where a step takes some seconds.
    void Tell(std::vector<double>& out, double step) const {
        const Vector3d rates = payload_->WorldAngularVel(), velocity = Velocity();
        const Quaterniond attitude = Turn(-0.5 * step * rates) * payload_->WorldPose().Rot();
        Put(out, Mean([](const auto& link) { return link->WorldCoGPose().Pos(); }) - 0.5 * step * velocity);
        Put(out, velocity);
        out.insert(out.end(), {attitude.W(), attitude.X(), attitude.Y(), attitude.Z()});
        Put(out, attitude.RotateVectorReverse(rates));
    }

    // Append what was felt over a step of some seconds, in the body axes at its start.
    void Feel(std::vector<double>& out, double step, const Vector3d& gravity) const {
        const Vector3d acceleration = (payload_->WorldLinearVel() - payload_velocity_) / step;
        Put(out, before_.RotateVectorReverse(acceleration - gravity));
        const std::size_t N = joints_.size(), at = out.size();
        out.resize(at + 6 * N);
        const Quaterniond back = before_.Inverse() * payload_->WorldPose().Rot();  // Gazebo turns them by the end's
        for (std::size_t i = 0; i < N; ++i) {
            // body2Force is what the child, a quadrotor, puts on its parent, in the child's axes, torque at the joint
            const auto felt = joints_[i]->GetForceTorque(0);
            const Vector3d force = back * felt.body2Force, torque = back * felt.body2Torque;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                out[at + axis * N + i] = force[axis];
                out[at + (3 + axis) * N + i] = torque[axis];
            }
        }
    }

    // The mean force over a step of some seconds that changed the momentum beside gravity and what was applied here.
    Vector3d Unexplained(double step, const Vector3d& gravity) const {
        return mass_ * (Change() / step - gravity) - applied_;
    }

  private:
    gazebo::physics::LinkPtr Link(const std::string& name) const {
        const auto link = model_->GetLink(name);
        if (!link) throw std::runtime_error("no link " + name);
        return link;
    }

    // The mean of something of the links, weighed by their mass.
    template <typename Of>
    Vector3d Mean(Of of) const {
        Vector3d sum;
        for (const auto& link : links_) sum += link->GetInertial()->Mass() * of(link);
        return sum / mass_;
    }

    Vector3d Velocity() const {
        return Mean([](const auto& link) { return link->WorldCoGLinearVel(); });
    }

    // Of the velocity of the vehicle's centre of mass since the step began [m/s].
    Vector3d Change() const {
        Vector3d momentum;
        for (std::size_t i = 0; i < links_.size(); ++i)
            momentum += links_[i]->GetInertial()->Mass() * (links_[i]->WorldCoGLinearVel() - velocities_[i]);
        return momentum / mass_;
    }

    gazebo::physics::ModelPtr model_;
    gazebo::physics::LinkPtr payload_;
    std::vector<gazebo::physics::LinkPtr> quadrotors_, links_;
    std::vector<gazebo::physics::JointPtr> joints_;
    std::vector<Pose3d> offsets_;  // of links in the payload's frame
    Vector3d center_;
    double mass_ = 0.0;
    Vector3d applied_, payload_velocity_;  // of this step [N, world]; at its start [m/s]
    Quaterniond before_;
    std::vector<Vector3d> velocities_;     // of all links' centres of mass, at its start [m/s, world]
};

}  // namespace tandemlift
