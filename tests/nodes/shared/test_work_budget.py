from nodes.shared.work_budget import WorkBudget
from tracker.containers import PerceptionWork


def test_nothing_is_limited_while_the_node_keeps_up():
    assert WorkBudget().after(PerceptionWork(places=2, hands=3), 0.6, 2) is None


def test_a_busy_node_does_one_run_less_each_time_but_one():
    budget = WorkBudget()
    assert budget.after(PerceptionWork(places=2, hands=3), 0.9, 2) == 4
    assert budget.after(PerceptionWork(places=1, hands=3), 0.9, 2) == 3
    assert budget.after(PerceptionWork(places=1, hands=0), 0.9, 2) == 1


def test_the_budget_stays_while_the_load_is_fair_and_grows_until_all_is_searched():
    budget = WorkBudget()
    budget.after(PerceptionWork(places=4, hands=1), 0.9, 4)
    assert budget.after(PerceptionWork(places=3, hands=1), 0.6, 4) == 4
    assert budget.after(PerceptionWork(places=3, hands=1), 0.4, 4) == 5
    assert budget.after(PerceptionWork(places=4, hands=1), 0.4, 4) is None
