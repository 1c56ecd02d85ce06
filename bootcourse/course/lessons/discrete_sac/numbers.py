"""Numbers that the lesson's text prints: the panel of Round 1 as it opens, and the best policy of Round 3."""

import math

import numpy as np

from bootcourse.course.lessons.discrete_sac.explorable import ALPHA, START

q = np.array(START)
pi = np.exp(q / ALPHA) / np.exp(q / ALPHA).sum()
BY_Q = pi @ q
WORTH = BY_Q - ALPHA * pi @ np.log(pi)
SOFTMAX = math.exp(3) / (math.e + math.exp(3))  # of Q = 1 and 3 with α = 1, the second action
