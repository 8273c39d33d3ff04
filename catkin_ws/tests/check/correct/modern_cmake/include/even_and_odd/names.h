#ifndef EVEN_AND_ODD_NAMES_H
#define EVEN_AND_ODD_NAMES_H

namespace even_and_odd
{
constexpr char TOPIC[] = "great_topic";
constexpr unsigned QUEUE_SIZE = 10;
constexpr double PERIOD = 0.5;  // seconds
}  // namespace even_and_odd

#endif
