// Somebody in ROS 2, as far as the wire tells: Fast DDS, with messages packed and unpacked by hand with Fast CDR.
//
//   dds_peer DOMAIN VERB ARGUMENT... [then VERB ARGUMENT...]...
//
//   read COUNT                        lines of COUNT odometry messages: stamp [ns], frames, 13 numbers
//   push FRAME FX FY FZ SECONDS       wrenches, 20 a second
//   request WORDS                     asks, and prints the answer
//   set KEY VALUE                     sets a parameter
//   mission                           the latched mission, as who comes late gets it
//
// What each verb prints begins with a line "# VERB".
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <functional>
#include <string>
#include <thread>
#include <vector>

using namespace eprosima::fastdds::dds;
using eprosima::fastcdr::Cdr;
using eprosima::fastcdr::FastBuffer;
using Bytes = std::vector<char>;
using Payload = eprosima::fastrtps::rtps::SerializedPayload_t;

const size_t MOST = 100000;
const auto PATIENCE = std::chrono::seconds(300);
const auto SETTLE = std::chrono::seconds(4);  // from when we know of the others until they surely know of us

// A type of which only the name is known; its values are what is on the wire.
class Raw : public TopicDataType
{
public:
    explicit Raw(const std::string& name) { setName(name.c_str()); m_typeSize = MOST; m_isGetKeyDefined = false; }
    bool serialize(void* data, Payload* payload) override
    {
        const Bytes& bytes = *static_cast<Bytes*>(data);
        memcpy(payload->data, bytes.data(), bytes.size());
        payload->length = bytes.size();
        payload->encapsulation = CDR_LE;
        return true;
    }
    bool deserialize(Payload* payload, void* data) override
    {
        static_cast<Bytes*>(data)->assign(payload->data, payload->data + payload->length);
        return true;
    }
    std::function<uint32_t()> getSerializedSizeProvider(void* data) override
    {
        return [data] { return uint32_t(static_cast<Bytes*>(data)->size()); };
    }
    void* createData() override { return new Bytes; }
    void deleteData(void* data) override { delete static_cast<Bytes*>(data); }
    bool getKey(void*, eprosima::fastrtps::rtps::InstanceHandle_t*, bool) override { return false; }
};

DomainParticipant* participant;

Topic* topic(const std::string& name, const std::string& type)
{
    const std::string whole = "rt/tandemlift/" + name;
    TypeSupport(new Raw(type)).register_type(participant);
    auto* made = static_cast<Topic*>(participant->lookup_topicdescription(whole));
    return made ? made : participant->create_topic(whole, type, TOPIC_QOS_DEFAULT);
}

template <typename Qos> Qos reliable(Qos qos, bool latched)
{
    qos.reliability().kind = RELIABLE_RELIABILITY_QOS;
    qos.durability().kind = latched ? TRANSIENT_LOCAL_DURABILITY_QOS : VOLATILE_DURABILITY_QOS;
    qos.history().kind = KEEP_LAST_HISTORY_QOS;
    qos.history().depth = latched ? 1 : 1000;
    return qos;
}

DataReader* reader(const std::string& name, const std::string& type, bool latched = false)
{
    Subscriber* subscriber = participant->create_subscriber(SUBSCRIBER_QOS_DEFAULT);
    return subscriber->create_datareader(topic(name, type), reliable(DATAREADER_QOS_DEFAULT, latched));
}

DataWriter* writer(const std::string& name, const std::string& type)
{
    Publisher* publisher = participant->create_publisher(PUBLISHER_QOS_DEFAULT);
    return publisher->create_datawriter(topic(name, type), reliable(DATAWRITER_QOS_DEFAULT, false));
}

void wait_for_readers(DataWriter* of)
{
    PublicationMatchedStatus status;
    for (auto end = std::chrono::steady_clock::now() + PATIENCE; std::chrono::steady_clock::now() < end;)
    {
        of->get_publication_matched_status(status);
        if (status.current_count > 0) return;
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    fprintf(stderr, "nobody listens\n");
    exit(1);
}

// Hand so many messages to a function.
void read(DataReader* from, int count, const std::function<void(Cdr&)>& heed)
{
    Bytes bytes;
    SampleInfo info;
    auto end = std::chrono::steady_clock::now() + PATIENCE;
    while (count > 0)
    {
        if (from->take_next_sample(&bytes, &info) == ReturnCode_t::RETCODE_OK)
        {
            if (!info.valid_data) continue;
            FastBuffer buffer(bytes.data(), bytes.size());
            Cdr cdr(buffer, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR);
            cdr.read_encapsulation();
            heed(cdr);
            --count;
        }
        else if (std::chrono::steady_clock::now() > end) { fprintf(stderr, "no more messages\n"); exit(1); }
        else std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}

void write(DataWriter* to, const std::function<void(Cdr&)>& fill)
{
    Bytes bytes(MOST);
    FastBuffer buffer(bytes.data(), bytes.size());
    Cdr cdr(buffer, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR);
    cdr.serialize_encapsulation();
    fill(cdr);
    bytes.resize(cdr.getSerializedDataLength());
    to->write(&bytes);
}

void print_odometry(Cdr& cdr)
{
    int32_t sec;
    uint32_t nanosec;
    std::string frame, child;
    double pose[7], twist[6], covariance[36];
    cdr >> sec >> nanosec >> frame >> child;
    cdr.deserializeArray(pose, 7).deserializeArray(covariance, 36).deserializeArray(twist, 6);
    printf("%lld %s %s", sec * 1000000000LL + nanosec, frame.c_str(), child.c_str());
    for (double number : pose) printf(" %.17g", number);
    for (double number : twist) printf(" %.17g", number);
    printf("\n");
}

void print_text(Cdr& cdr)
{
    std::string text;
    cdr >> text;
    printf("%s\n", text.c_str());
}

void push(DataWriter* to, char** words)
{
    for (int k = 0; k < 20 * atof(words[4]); ++k)
    {
        write(to, [&](Cdr& cdr) {
            cdr << int32_t(0) << uint32_t(0) << std::string(words[0]);
            for (int i = 1; i < 4; ++i) cdr << atof(words[i]);
            for (int i = 0; i < 3; ++i) cdr << 0.0;
        });
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
}

int main(int count, char** words)
{
    const std::string text = "std_msgs::msg::dds_::String_", odometry = "nav_msgs::msg::dds_::Odometry_";
    participant = DomainParticipantFactory::get_instance()->create_participant(atoi(words[1]), PARTICIPANT_QOS_DEFAULT);
    DataReader *answers = reader("answer", text);
    DataWriter *pushes = writer("push", "geometry_msgs::msg::dds_::WrenchStamped_"), *requests = writer("request", text),
               *settings = writer("parameter", "diagnostic_msgs::msg::dds_::KeyValue_");
    for (DataWriter* one : {pushes, requests, settings}) wait_for_readers(one);
    std::this_thread::sleep_for(SETTLE);
    for (int at = 2; at < count; ++at)
    {
        const std::string verb = words[at];
        if (verb != "then") printf("# %s\n", verb.c_str());
        if (verb == "read") read(reader("odometry", odometry), atoi(words[++at]), print_odometry);
        else if (verb == "mission") read(reader("mission", text, true), 1, print_text);
        else if (verb == "push") { push(pushes, words + at + 1); at += 5; }
        else if (verb == "request")
        {
            write(requests, [&](Cdr& cdr) { cdr << std::string(words[at + 1]); });
            read(answers, 1, print_text);
            ++at;
        }
        else if (verb == "set")
        {
            write(settings, [&](Cdr& cdr) { cdr << std::string(words[at + 1]) << std::string(words[at + 2]); });
            at += 2;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(300));  // for the last message to arrive
    }
    return 0;
}
