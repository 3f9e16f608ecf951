/* The lockstep protocol of docs/architecture.md, for spin (bus/lockstep/lockstep_conductor.h, bus/lockstep/lockstep_participant.h).
 *
 * A run is STEPS rounds; in each every one of PARTS participants takes one turn. What is in a turn is left out; so are
 * windows (a turn is a turn), slices (a datagram is a datagram) and who is due (all are, always).
 *
 * Datagrams are kept as a set. One that was said may be heard at any later time (delayed, overtaken), again and again
 * (doubled), or be lost (LOSSES of them; saying it again puts it back). The first MORTALS participants and the conductor die at any
 * instant, LIVES - 1 and CONDUCTOR_LIVES - 1 times each, and are started again: a participant with nothing, the conductor with its journal.
 *
 * Transitions that change nothing (a datagram heard that has no effect) are left out. Every other one adds a datagram,
 * a turn, a life or a round, or uses up a loss, so no state comes twice, every execution is finite, and spin's search for
 * invalid end states proves that every execution ends with the run over: no deadlock, no livelock, provided that what
 * is said again and again is heard at last. The assertions are the safety claims:
 *   early    nobody takes turn k before all have taken turn k - 1 (in some life), and it is in the journal;
 *   passed   no round goes into the journal before all have taken their turn of it;
 *   behind   no participant is ahead of the journal by more than the round.
 *
 * Mutants of the protocol that the check must refuse (tests/lockstep_model/check): see #ifdef.
 */

#ifndef PARTS
#define PARTS 2
#endif
#ifndef STEPS
#define STEPS 2
#endif
#ifndef LIVES
#define LIVES 2
#endif
#ifndef MORTALS
#define MORTALS PARTS
#endif
#ifndef CONDUCTOR_LIVES
#define CONDUCTOR_LIVES 2
#endif
#ifndef LOSSES
#define LOSSES 1
#endif

/* The datagrams that were said and not lost: bit k of [p, l] is the one about turn k to or from life l of p. */
#define AT(p, l) ((p) * (LIVES + 1) + (l))
#define BIT(k) (1 << (k))
byte grant[PARTS * (LIVES + 1)];
byte answer[PARTS * (LIVES + 1)];
byte join[PARTS * (LIVES + 1)];     /* bit t: "life l of p is here, and has taken t turns" */
byte losses = 0;
#ifdef MUTANT_NO_REPETITION
byte said_once[PARTS * (LIVES + 1)];
#endif

/* Participants. */
byte life[PARTS];                   /* 1, 2, ...: greater is later */
byte taken[PARTS];                  /* turns, in this life */
byte max_taken[PARTS];             /* turns, in any life */

/* On the conductor's disk. */
byte journal = 0;                   /* rounds */

/* In the conductor's memory. */
bool alive = true;
byte conductor_life = 1;
byte round = 1;                     /* under way */
byte known[PARTS];                  /* the life that takes part; 0: none known */
byte next_turn[PARTS];              /* that this life is to be granted, of the past or of the round */
byte answered = 0;                  /* bit p: its result of the round is here */
bool over = false;

#define ALL BIT(PARTS) - 1

/* What the conductor does about life l of p. */
proctype conductor_about(byte p, l) {
  byte t;
  do
  /* A later life than the one known is here, or the known one is further than thought. */
  :: atomic { alive && !over && l >= known[p] && join[AT(p, l)] != 0 &&
       (l > known[p] || (join[AT(p, l)] >> next_turn[p]) != 0 && next_turn[p] <= journal) ->
       t = 0;
       do  /* some such message is heard: the first, or another */
       :: (join[AT(p, l)] & BIT(t)) && (l > known[p] || t >= next_turn[p]) -> break
       :: t < STEPS && (join[AT(p, l)] >> (t + 1)) != 0 -> t++
       od;
       assert(t <= round);                                    /* behind */
       known[p] = l;
#ifdef MUTANT_NO_PAST
       next_turn[p] = round;
#else
       next_turn[p] = (t < round -> t + 1 : round);           /* t = round: its answer is wanted again */
#endif
       t = 0 }
  /* Says a grant, or says it again. */
#ifdef MUTANT_NO_REPETITION
  :: atomic { alive && !over && l == known[p] && next_turn[p] <= round && !(said_once[AT(p, l)] & BIT(next_turn[p])) ->
       said_once[AT(p, l)] = said_once[AT(p, l)] | BIT(next_turn[p]);
#else
  :: atomic { alive && !over && l == known[p] && next_turn[p] <= round && !(grant[AT(p, l)] & BIT(next_turn[p])) ->
#endif
       grant[AT(p, l)] = grant[AT(p, l)] | BIT(next_turn[p]) }
  /* Hears an answer. */
#ifdef MUTANT_ANSWER_OF_ANY_TURN
  :: atomic { alive && !over && l == known[p] && answer[AT(p, l)] != 0 && !(answered & BIT(p)) ->
       answered = answered | BIT(p);
       next_turn[p] = round + 1 }
#else
  :: atomic { alive && !over && l == known[p] && next_turn[p] <= round && (answer[AT(p, l)] & BIT(next_turn[p])) ->
       if
       :: next_turn[p] == round -> answered = answered | BIT(p)
       :: else -> skip
       fi;
       next_turn[p]++ }
#endif
  :: over -> break
  od
}

/* What the conductor does by itself. */
proctype conductor() {
  byte p;
  do
  /* All have answered: the round goes into the journal, and after that the next begins. */
#ifdef MUTANT_GRANT_BEFORE_JOURNAL
  :: atomic { alive && !over && answered == ALL && round < STEPS -> round++; answered = 0 }
  :: atomic { alive && !over && journal + 1 < round -> journal++ }
  :: atomic { alive && !over && answered == ALL && round == STEPS && journal == STEPS - 1 -> journal = STEPS; over = true }
#else
  :: atomic { alive && !over && answered == ALL ->
       p = 0;
       do
       :: p < PARTS -> assert(max_taken[p] >= round); p++    /* passed */
       :: else -> break
       od;
       p = 0;
       journal = round;
       answered = 0;
       round++;
       over = (journal == STEPS) }
#endif
  /* Dies, and is started again with its journal alone. */
  :: atomic { alive && !over && conductor_life < CONDUCTOR_LIVES -> alive = false }
  :: atomic { !alive ->
       alive = true;
       conductor_life++;
       round = journal + 1;
       answered = 0;
       p = 0;
       do
       :: p < PARTS -> known[p] = 0; next_turn[p] = 0; p++
       :: else -> break
       od;
       p = 0 }
  :: over -> break
  od
}

proctype participant(byte p) {
  byte q;
  do
  /* Says that it is here, or says it again, while the conductor does not know it, or thinks it elsewhere. */
  :: atomic { !over && alive && !(join[AT(p, life[p])] & BIT(taken[p])) &&
       (known[p] != life[p] || next_turn[p] < taken[p]) ->
       join[AT(p, life[p])] = join[AT(p, life[p])] | BIT(taken[p]) }
  /* Hears the grant of its next turn, takes it, and answers. */
#ifdef MUTANT_NO_TURN_NUMBER
  :: atomic { !over && taken[p] < STEPS && (grant[AT(p, life[p])] >> 1) != 0 ->
#else
  :: atomic { !over && taken[p] < STEPS && (grant[AT(p, life[p])] & BIT(taken[p] + 1)) ->
#endif
       taken[p]++;
       assert(taken[p] <= journal + 1);                       /* early */
       q = 0;
       do
       :: q < PARTS -> assert(max_taken[q] + 1 >= taken[p]); q++
       :: else -> break
       od;
       q = 0;
       grant[AT(p, life[p])] = grant[AT(p, life[p])] & ~(BIT(taken[p]) - 1);   /* without effect from here on */
       max_taken[p] = (taken[p] > max_taken[p] -> taken[p] : max_taken[p]);
       answer[AT(p, life[p])] = answer[AT(p, life[p])] | BIT(taken[p]) }
  /* Hears the grant of its last turn again: gives the same answer again. */
  :: atomic { !over && taken[p] > 0 && (grant[AT(p, life[p])] & BIT(taken[p])) &&
       !(answer[AT(p, life[p])] & BIT(taken[p])) ->
       answer[AT(p, life[p])] = answer[AT(p, life[p])] | BIT(taken[p]) }
  /* Dies, and is started again with nothing. */
  :: atomic { !over && p < MORTALS && life[p] < LIVES ->
       grant[AT(p, life[p])] = 0;                             /* nobody is there to hear it */
       life[p]++;
       taken[p] = 0 }
  :: over -> break
  od
}

/* Loses what was said to or by life l of p. */
proctype network(byte p, l) {
  byte k;
  do
  :: atomic { !over && losses < LOSSES && (grant[AT(p, l)] | answer[AT(p, l)] | join[AT(p, l)]) != 0 ->
       losses++;
       k = 0;
       do
       :: grant[AT(p, l)] & BIT(k) -> grant[AT(p, l)] = grant[AT(p, l)] & ~BIT(k); break
       :: answer[AT(p, l)] & BIT(k) -> answer[AT(p, l)] = answer[AT(p, l)] & ~BIT(k); break
       :: join[AT(p, l)] & BIT(k) -> join[AT(p, l)] = join[AT(p, l)] & ~BIT(k); break
       :: k < STEPS && ((grant[AT(p, l)] | answer[AT(p, l)] | join[AT(p, l)]) >> (k + 1)) != 0 -> k++
       od;
       k = 0 }
  :: over -> break
  od
}

init {
  byte p, l;
  atomic {
    p = 0;
    do
    :: p < PARTS ->
       life[p] = 1;
       run participant(p);
       l = 1;
       do
       :: l <= LIVES -> run conductor_about(p, l); run network(p, l); l++
       :: else -> break
       od;
       p++
    :: else -> break
    od;
    run conductor()
  }
}
