// The body of a flight: the vehicle in lock-step with a pilot, whose messages come by a Front (UDP, ROS).
//
// Modes
//   alone    no pilot: rotors off, the world goes on in real time and never waits (unless <wait> is set)
//   led      a pilot leads: before every step the world waits for its message
//   holding  the pilot was silent for <patience> seconds: its last thrusts act for <hold> seconds more, then alone
// While the world waits its time stands still. A new pilot is heard in every mode.
//
// Settings of the <plugin>, all of them optional
//   <wait>      true: wait for the first pilot, at most a minute, before the first step; false
//   <patience>  s of real time after which a silent pilot is given up, 0 for never; 1
//   <hold>      s of simulated time for which its last thrusts are held; 0.1
//   <stay>      false: the server ends when the pilot says goodbye or the process that started it has ended; true
//
// Numbers, of N quadrotors
//   Command  thrusts (4 N) [N]; at the vehicle's centre of mass force [N, world] and moment [N m, body]; at the
//            payload's origin, likewise; on every quadrotor at its centre of mass force x, y, z (each of all N) and
//            moment, likewise
//   Told     time [s], step [s], mass [kg]; State after the step; what was felt at its start: specific force at the
//            payload's origin (3), force x, y, z and torque x, y, z of every quadrotor on the payload at its joint
//            (6 N, body), force of contacts (3, world); Touches (contacts.hh); force [N, world] and moment [N m, body]
//            about the centre of mass of all pushes over the step. A wrench of Gazebo's own tools is a push, too: its
//            force is what else has changed the momentum; its moment is not known, and NaN
//   Rotors   of all 4 N: x [m], then y [m] from the quadrotor's centre of mass, then torque over thrust [m] (signed)

#pragma once

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

#include <gazebo/msgs/msgs.hh>
#include <gazebo/transport/transport.hh>

#include "contacts.hh"
#include "push.hh"
#include "vehicle.hh"

namespace tandemlift {

using Clock = std::chrono::steady_clock;

constexpr double LONGEST_WAIT = 60.0;  // s, for the first pilot
constexpr int GLANCE = 50;             // ms, between looks at whether the server is to end
constexpr double LEAST_WRENCH = 1e-3;  // N, of Gazebo's own tools, and in each newton of contact; below is rounding

// Where a pilot's messages come from, and the answers go; called in the physics thread alone.
class Front {
  public:
    virtual bool Hear(int milliseconds) = 0;  // wait for a message and heed it; whether there was one
    virtual void Tell() = 0;                  // a step was taken

  protected:
    ~Front() = default;
};

class Body {
  public:
    ~Body() { ending_ = true; }

    // Throws std::runtime_error with what is missing in the model.
    void Load(const gazebo::physics::ModelPtr& model, const sdf::ElementPtr& settings) {
        world_ = model->GetWorld();
        waiting_ = settings->Get<bool>("wait", false).first;
        patience_ = settings->Get<double>("patience", 1.0).first;
        hold_ = settings->Get<double>("hold", 0.1).first;
        stay_ = settings->Get<bool>("stay", true).first;
        vehicle_.Load(model);
        contacts_.Load(model, Count());
    }

    // Be led by what comes from a front from now on.
    void Start(Front& front) {
        front_ = &front;
        Rest();
        heard_ = Clock::now();
        node_ = gazebo::transport::NodePtr(new gazebo::transport::Node());
        node_->Init(world_->Name());
        heard_topics_.push_back(node_->Subscribe("~/tandemlift/push", &Body::OnPush, this));
        for (const auto& link : vehicle_.Links())
            heard_topics_.push_back(node_->Subscribe("~/tandemlift/" + link->GetName() + "/wrench", &Body::OnWrench, this));
        using gazebo::event::Events;
        begin_ = Events::ConnectWorldUpdateBegin([this](const auto&) { Begin(); });
        end_ = Events::ConnectWorldUpdateEnd([this] { front_->Tell(); });
        stop_ = Events::ConnectStop([this] { ending_ = true; });
        interrupt_ = Events::ConnectSigInt([this] { ending_ = true; });
    }

    std::size_t Count() const { return vehicle_.Count(); }
    double StepSize() const { return world_->Physics()->GetMaxStepSize(); }
    double Mass() const { return vehicle_.Mass(); }
    bool Led() const { return mode_ == Mode::LED; }
    bool Due() const { return due_; }  // whether the pilot's message for this step is there

    // What a front heard, in the physics thread

    // A new pilot, with these Rotors: the world waits for it from now on.
    void Lead(std::vector<double> rotors) {
        rotors_ = std::move(rotors);
        step_.assign(10 * Count() + 12, 0.0);
        mode_ = Mode::LED;
        waiting_ = due_ = false;
        Alive();
    }

    // Whether a world that is led is kept to real time.
    void Pace(bool real_time) { world_->Physics()->SetRealTimeUpdateRate(real_time ? 1.0 / StepSize() : 0.0); }

    // Put the vehicle into the State that begins there; all pushes end.
    void Place(const std::vector<double>& values, std::size_t at) {
        EndPushes();
        vehicle_.Place(values, at, StepSize());
    }

    // The pilot lives.
    void Alive() { heard_ = Clock::now(); }

    // The Command of the step that is due.
    void Take(std::vector<double> command) {
        step_ = std::move(command);
        due_ = true;
    }

    void Goodbye() {
        gzmsg << "tandemlift: the pilot says goodbye; rotors off\n";
        Rest();
        if (!stay_) Leave();
    }

    // A push that is held beside those by Gazebo's topic, until the next of these; also from other threads.
    void Hold(const Push& push) {
        std::lock_guard<std::mutex> lock(pushes_mutex_);
        held_push_ = push;
    }

    void EndPushes() {
        std::lock_guard<std::mutex> lock(pushes_mutex_);
        pushes_.clear();
        held_push_.left = 0.0;
    }

    // What there is to tell: Told, of the step just taken.
    void Tell(std::vector<double>& told) {
        TellMotion(told);
        Vector3d contact;
        const auto touches = contacts_.Read(contact);
        const Vector3d wrench = vehicle_.Unexplained(StepSize(), world_->Gravity()) - contact;
        Put(told, contact);
        told.insert(told.end(), touches.begin(), touches.end());
        const bool foreign = wrench.Length() > LEAST_WRENCH * (1.0 + contact.Length());
        const bool heard = wrench_heard_.exchange(false);
        Put(told, foreign ? pushed_force_ + wrench : pushed_force_);
        Put(told, foreign || heard ? Vector3d(NAN, NAN, NAN) : pushed_moment_);
    }

    // The same where it stands, before a step: nothing touches or pushes it yet.
    void TellStanding(std::vector<double>& told) {
        BeginStep();
        TellMotion(told);
        told.resize(told.size() + 3 + contacts_.Count() + 6);
    }

  private:
    enum class Mode { ALONE, LED, HOLDING };

    // Before every step of the world.
    void Begin() {
        due_ = false;
        while (!ending_) {
            const bool wait = (mode_ == Mode::LED && !due_) || waiting_;
            if (!front_->Hear(wait ? GLANCE : 0)) {
                if (!wait) break;
                GiveUp();
            } else if (due_) {
                break;
            }
        }
        BeginStep();
        if (mode_ == Mode::HOLDING && (held_ += StepSize()) > hold_) Rest();
        if (mode_ != Mode::ALONE) Act();
        ApplyPushes();
    }

    void TellMotion(std::vector<double>& told) const {
        told.assign({world_->SimTime().Double(), StepSize(), vehicle_.Mass()});
        vehicle_.Tell(told, StepSize());
        vehicle_.Feel(told, StepSize(), world_->Gravity());
    }

    void BeginStep() {
        vehicle_.Begin();
        pushed_force_ = pushed_moment_ = Vector3d::Zero;
    }

    // Give up a pilot that is silent for too long, or the wait for a first one.
    void GiveUp() {
        const double silent = std::chrono::duration<double>(Clock::now() - heard_).count();
        if (!stay_ && getppid() != parent_) {
            Leave();
            ending_ = true;
        } else if (mode_ == Mode::LED && patience_ > 0.0 && silent > patience_) {
            gzwarn << "tandemlift: the pilot is silent; its thrusts are held for " << hold_ << " s, then rotors off\n";
            mode_ = Mode::HOLDING;
            held_ = 0.0;
            std::fill(step_.begin() + 4 * Count(), step_.end(), 0.0);  // only rotors are held
            Pace(true);
        } else if (waiting_ && silent > LONGEST_WAIT) {
            waiting_ = false;
        }
    }

    // Rotors off, in real time.
    void Rest() {
        mode_ = Mode::ALONE;
        Pace(true);
    }

    void Leave() const { std::raise(SIGINT); }  // as if someone had ended the server

    // Apply the pilot's last command.
    void Act() {
        const std::size_t N = Count(), loads = 4 * N + 12;
        vehicle_.Load(Three(step_, 4 * N), Three(step_, 4 * N + 3), vehicle_.Center());
        vehicle_.Load(Three(step_, 4 * N + 6), Three(step_, 4 * N + 9), Vector3d::Zero);
        for (std::size_t i = 0; i < N; ++i) {
            double thrust = 0.0;
            Vector3d moment;
            for (std::size_t j = 4 * i; j < 4 * i + 4; ++j) {
                const double x = rotors_[j], y = rotors_[4 * N + j], torque = rotors_[8 * N + j];
                thrust += step_[j];
                moment += Vector3d(y, -x, torque) * step_[j];
            }
            vehicle_.Lift(i, thrust, moment);
            vehicle_.Load(i, Three(step_, loads + i, N), Three(step_, loads + 3 * N + i, N));
        }
    }

    void ApplyPushes() {
        std::lock_guard<std::mutex> lock(pushes_mutex_);
        if (held_push_.left > 0.0) Apply(held_push_);
        for (auto push = pushes_.begin(); push != pushes_.end();) {
            Apply(*push);
            push = push->left > 0.0 ? push + 1 : pushes_.erase(push);
        }
    }

    void Apply(Push& push) {
        const double step = StepSize();
        pushed_force_ += push.force;
        pushed_moment_ += vehicle_.Pushed(push);
        push.left -= step;
        if (push.left < 0.5 * step) push.left = 0.0;
    }

    // In a thread of Gazebo's transport.
    void OnPush(ConstGzStringPtr& message) {
        if (message->data() == "off") return EndPushes();
        try {
            const Push push = ReadPush(message->data());
            std::lock_guard<std::mutex> lock(pushes_mutex_);
            pushes_.push_back(push);
        } catch (const std::invalid_argument& error) {
            gzerr << "tandemlift: push '" << message->data() << "': " << error.what()
                  << "; say: force FX FY FZ [point X Y Z] [duration S]\n";
        }
    }

    // A wrench of Gazebo's own tools on a link, in such a thread.
    void OnWrench(ConstWrenchPtr&) { wrench_heard_ = true; }

    gazebo::physics::WorldPtr world_;
    Vehicle vehicle_;
    Contacts contacts_;
    Front* front_ = nullptr;
    bool waiting_ = false, stay_ = true;
    const pid_t parent_ = getppid();
    double patience_ = 1.0, hold_ = 0.1, held_ = 0.0;
    Mode mode_ = Mode::ALONE;
    bool due_ = false;
    std::vector<double> rotors_, step_;
    Clock::time_point heard_;
    Vector3d pushed_force_, pushed_moment_;  // over this step
    std::mutex pushes_mutex_;
    std::vector<Push> pushes_;
    Push held_push_{};
    std::atomic<bool> ending_{false}, wrench_heard_{false};
    gazebo::transport::NodePtr node_;
    std::vector<gazebo::transport::SubscriberPtr> heard_topics_;
    gazebo::event::ConnectionPtr begin_, end_, stop_, interrupt_;
};

}  // namespace tandemlift
