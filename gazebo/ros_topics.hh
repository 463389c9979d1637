// What a step told, as ROS messages; the topics are told of in tandemlift_gazebo_ros.cc.

#pragma once

#include <string>
#include <vector>

#include <geometry_msgs/WrenchStamped.h>
#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Clock.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/MultiDOFJointState.h>

#include "vehicle.hh"

namespace tandemlift {

using geometry_msgs::Wrench;
using geometry_msgs::WrenchStamped;
using sensor_msgs::MultiDOFJointState;

constexpr int ROOM = 1000;  // messages kept for those who are slow to hear them

// Where the parts of Told begin.
enum At : std::size_t { POSITION = 3, VELOCITY = 6, ATTITUDE = 9, RATES = 13, SPECIFIC_FORCE = 16, JOINTS = 19 };

template <typename Of>
Of Ros(const Vector3d& v) {
    Of out;
    out.x = v.X(), out.y = v.Y(), out.z = v.Z();
    return out;
}

inline Wrench WrenchOf(const Vector3d& force, const Vector3d& torque = Vector3d::Zero) {
    Wrench out;
    out.force = Ros<geometry_msgs::Vector3>(force);
    out.torque = Ros<geometry_msgs::Vector3>(torque);
    return out;
}

template <typename Of>
Vector3d Math(const Of& v) {
    return {v.x, v.y, v.z};
}

// Publishes what a step told: the state, and for ROS's own tools, of which those nobody listens to cost nothing.
class Topics {
  public:
    void Open(ros::NodeHandle& node, std::size_t count) {
        state_topic_ = node.advertise<MultiDOFJointState>("state", ROOM, true);
        odometry_ = node.advertise<nav_msgs::Odometry>("odometry", ROOM);
        imu_ = node.advertise<sensor_msgs::Imu>("imu", ROOM);
        for (std::size_t i = 1; i <= count; ++i)
            joints_.push_back(node.advertise<WrenchStamped>("joint_" + std::to_string(i) + "/wrench", ROOM));
        contact_ = node.advertise<WrenchStamped>("contact/force", ROOM);
        push_ = node.advertise<WrenchStamped>("push/wrench", ROOM);
        clock_ = node.advertise<rosgraph_msgs::Clock>("/clock", ROOM);
        Lay(count);
    }

    // The state, all of Told.
    void Tell(const std::vector<double>& told, const ros::Time& stamp) {
        const std::size_t N = joints_.size();
        state_.header.stamp = stamp;
        auto& rotation = state_.transforms[0].rotation;
        state_.transforms[0].translation = Ros<geometry_msgs::Vector3>(Three(told, POSITION));
        rotation.w = told[ATTITUDE], rotation.x = told[ATTITUDE + 1];
        rotation.y = told[ATTITUDE + 2], rotation.z = told[ATTITUDE + 3];
        state_.twist[0].linear = Ros<geometry_msgs::Vector3>(Three(told, VELOCITY));
        state_.twist[0].angular = Ros<geometry_msgs::Vector3>(Three(told, RATES));
        state_.wrench[1] = WrenchOf(Three(told, SPECIFIC_FORCE));
        for (std::size_t i = 0; i < N; ++i)
            state_.wrench[2 + i] = WrenchOf(Three(told, JOINTS + i, N), Three(told, JOINTS + 3 * N + i, N));
        const std::size_t push = told.size() - 6, contact = JOINTS + 6 * N;
        state_.wrench[2 + N] = WrenchOf(Three(told, contact));
        state_.wrench[3 + N] = WrenchOf(Three(told, push), Three(told, push + 3));
        TellTouches(told, contact + 3);
        state_topic_.publish(state_);
    }

    // The same, one by one.
    void TellTools() const {
        const auto& pose = state_.transforms[0];
        const auto& q = pose.rotation;
        const Quaterniond attitude(q.w, q.x, q.y, q.z);
        if (Heard(odometry_)) {
            nav_msgs::Odometry out;
            out.header = state_.header;
            out.child_frame_id = "base_link";
            out.pose.pose.position = Ros<geometry_msgs::Point>(Math(pose.translation));
            out.pose.pose.orientation = q;
            out.twist.twist.linear =
                Ros<geometry_msgs::Vector3>(attitude.RotateVectorReverse(Math(state_.twist[0].linear)));
            out.twist.twist.angular = state_.twist[0].angular;
            odometry_.publish(out);
        }
        if (Heard(imu_)) {
            sensor_msgs::Imu out;
            out.header.stamp = state_.header.stamp;
            out.header.frame_id = "payload";
            out.orientation_covariance[0] = -1.0;  // there is none
            out.angular_velocity = state_.twist[0].angular;
            out.linear_acceleration = state_.wrench[1].force;
            imu_.publish(out);
        }
        const std::size_t N = joints_.size();
        for (std::size_t i = 0; i < N; ++i) Tell(joints_[i], state_.wrench[2 + i], state_.joint_names[2 + i]);
        Tell(contact_, state_.wrench[2 + N], "base_world");
        const auto& push = state_.wrench[3 + N];
        Tell(push_, WrenchOf(Math(push.force), attitude * Math(push.torque)), "base_world");
        if (Heard(clock_)) {
            rosgraph_msgs::Clock out;
            out.clock = state_.header.stamp;
            clock_.publish(out);
        }
    }

  private:
    // Name the parts that touch something, after all else.
    void TellTouches(const std::vector<double>& told, std::size_t at) {
        const std::size_t always = 4 + joints_.size();
        Resize(always);
        for (std::size_t row = 0; row < touches_.size(); ++row) {
            const std::size_t from = at + 4 * row;
            if (told[from] <= 0.0) continue;
            Resize(state_.joint_names.size() + 1);
            state_.joint_names.back() = touches_[row];
            state_.transforms.back().translation = Ros<geometry_msgs::Vector3>(Three(told, from + 1));
            state_.wrench.back() = WrenchOf({told[from], 0.0, 0.0});
        }
    }

    void Resize(std::size_t joints) {
        state_.joint_names.resize(joints);
        state_.transforms.resize(joints);
        state_.transforms.back().rotation.w = 1.0;
        state_.twist.resize(joints);
        state_.wrench.resize(joints);
    }

    void Lay(std::size_t count) {
        state_.header.frame_id = "world";
        state_.joint_names = {"base_link", "imu"};
        for (std::size_t i = 1; i <= count; ++i) state_.joint_names.push_back("joint_" + std::to_string(i));
        state_.joint_names.insert(state_.joint_names.end(), {"contact", "push"});
        for (const std::string surface : {"floor/", "wall/"}) {
            for (std::size_t j = 0; j < 4 * count; ++j)
                touches_.push_back(surface + "rotor_" + std::to_string(j / 4 + 1) + "_" + std::to_string(j % 4 + 1));
            for (std::size_t i = 1; i <= count; ++i) touches_.push_back(surface + "guard_" + std::to_string(i));
            touches_.push_back(surface + "beam");
        }
        state_.transforms.resize(state_.joint_names.size());
        for (auto& transform : state_.transforms) transform.rotation.w = 1.0;
        state_.twist.resize(state_.joint_names.size());
        state_.wrench.resize(state_.joint_names.size());
    }

    static bool Heard(const ros::Publisher& topic) { return topic.getNumSubscribers() > 0; }

    void Tell(const ros::Publisher& topic, const Wrench& wrench, const std::string& frame) const {
        if (!Heard(topic)) return;
        WrenchStamped out;
        out.header.stamp = state_.header.stamp;
        out.header.frame_id = frame;
        out.wrench = wrench;
        topic.publish(out);
    }

    MultiDOFJointState state_;
    ros::Publisher state_topic_, odometry_, imu_, contact_, push_, clock_;
    std::vector<ros::Publisher> joints_;
    std::vector<std::string> touches_;  // names of the rows of Touches
};

}  // namespace tandemlift
