#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Answer a service by a helper which always raises, if the request cannot be used."""

import rospy
from std_srvs.srv import SetBool, SetBoolResponse


def refuse(why):
    raise rospy.ServiceException(why)


def answer(request):
    if request.data:
        return SetBoolResponse(success=True, message="yes")
    return refuse("only true can be set")


def main():
    rospy.init_node("handler_raises")
    rospy.Service("answer_py", SetBool, answer)
    rospy.spin()


if __name__ == "__main__":
    main()
