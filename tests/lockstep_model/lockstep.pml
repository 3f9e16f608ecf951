/* The lockstep protocol of docs/architecture.md, for spin (bus/lockstep/lockstep_conductor.h, bus/lockstep/lockstep_participant.h).
 *
 * A run is STEPS rounds; in each every one of PARTS participants takes one turn. Abstracted away: the contents of turns,
 * lookahead, slices, and due instants (all are due, always).
 *
 * Datagrams are kept as a set. One that was sent may be received at any later time (delayed, reordered), again and again
 * (duplicated), or be lost (LOSSES of them; a retransmission puts it back). The first CRASHING participants and the conductor
 * crash at any instant, STARTS - 1 and CONDUCTOR_STARTS - 1 times each, and are restarted: a participant with nothing, the
 * conductor with its journal.
 *
 * Transitions that change nothing (a datagram received without effect) are left out. Every other one adds a datagram,
 * a turn, an incarnation or a round, or uses up a loss, so no state comes twice, every execution is finite, and spin's search for
 * invalid end states proves that every execution ends with the run over: no deadlock, no livelock, provided that a message
 * retransmitted without end is received at last (fair loss). The assertions are the safety claims:
 *   early    nobody takes turn k before all have taken turn k - 1 (in some incarnation), and it is in the journal;
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
#ifndef STARTS
#define STARTS 2
#endif
#ifndef CRASHING
#define CRASHING PARTS
#endif
#ifndef CONDUCTOR_STARTS
#define CONDUCTOR_STARTS 2
#endif
#ifndef LOSSES
#define LOSSES 1
#endif

/* The datagrams that were sent and not lost: bit k of [p, l] is the one about turn k to or from incarnation l of p. */
#define AT(p, l) ((p) * (STARTS + 1) + (l))
#define BIT(k) (1 << (k))
byte grant[PARTS * (STARTS + 1)];
byte answer[PARTS * (STARTS + 1)];
byte join[PARTS * (STARTS + 1)];     /* bit t: incarnation l of p is present, and has taken t turns */
byte losses = 0;
#ifdef MUTANT_NO_RETRANSMISSION
byte sent_once[PARTS * (STARTS + 1)];
#endif

/* Participants. */
byte incarnation[PARTS];                   /* 1, 2, ...: greater is later */
byte taken[PARTS];                  /* turns, in this incarnation */
byte max_taken[PARTS];             /* turns, in any incarnation */

/* On the conductor's disk. */
byte journal = 0;                   /* rounds */

/* In the conductor's memory. */
bool alive = true;
byte conductor_incarnation = 1;
byte round = 1;                     /* under way */
byte known[PARTS];                  /* the incarnation that takes part; 0: none known */
byte next_turn[PARTS];              /* that this incarnation is to be granted, of the history or of the round */
byte answered = 0;                  /* bit p: its result of the round is here */
bool over = false;

#define ALL BIT(PARTS) - 1

/* The conductor towards incarnation l of p. */
proctype conductor_to(byte p, l) {
  byte t;
  do
  /* A JOIN of a later incarnation than the known one, or of the known one with more turns than known. */
  :: atomic { alive && !over && l >= known[p] && join[AT(p, l)] != 0 &&
       (l > known[p] || (join[AT(p, l)] >> next_turn[p]) != 0 && next_turn[p] <= journal) ->
       t = 0;
       do  /* some such message is received: the first, or another */
       :: (join[AT(p, l)] & BIT(t)) && (l > known[p] || t >= next_turn[p]) -> break
       :: t < STEPS && (join[AT(p, l)] >> (t + 1)) != 0 -> t++
       od;
       assert(t <= round);                                    /* behind */
       known[p] = l;
#ifdef MUTANT_NO_REPLAY
       next_turn[p] = round;
#else
       next_turn[p] = (t < round -> t + 1 : round);           /* t = round: its answer is requested again */
#endif
       t = 0 }
  /* Sends a grant, or retransmits it. */
#ifdef MUTANT_NO_RETRANSMISSION
  :: atomic { alive && !over && l == known[p] && next_turn[p] <= round && !(sent_once[AT(p, l)] & BIT(next_turn[p])) ->
       sent_once[AT(p, l)] = sent_once[AT(p, l)] | BIT(next_turn[p]);
#else
  :: atomic { alive && !over && l == known[p] && next_turn[p] <= round && !(grant[AT(p, l)] & BIT(next_turn[p])) ->
#endif
       grant[AT(p, l)] = grant[AT(p, l)] | BIT(next_turn[p]) }
  /* Receives an answer. */
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

/* The conductor on its own. */
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
  /* Crashes, and is restarted with its journal alone. */
  :: atomic { alive && !over && conductor_incarnation < CONDUCTOR_STARTS -> alive = false }
  :: atomic { !alive ->
       alive = true;
       conductor_incarnation++;
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
  /* Sends a JOIN, or retransmits it, while the conductor does not know it, or its turns. */
  :: atomic { !over && alive && !(join[AT(p, incarnation[p])] & BIT(taken[p])) &&
       (known[p] != incarnation[p] || next_turn[p] < taken[p]) ->
       join[AT(p, incarnation[p])] = join[AT(p, incarnation[p])] | BIT(taken[p]) }
  /* Receives the grant of its next turn, takes it, and answers. */
#ifdef MUTANT_NO_TURN_NUMBER
  :: atomic { !over && taken[p] < STEPS && (grant[AT(p, incarnation[p])] >> 1) != 0 ->
#else
  :: atomic { !over && taken[p] < STEPS && (grant[AT(p, incarnation[p])] & BIT(taken[p] + 1)) ->
#endif
       taken[p]++;
       assert(taken[p] <= journal + 1);                       /* early */
       q = 0;
       do
       :: q < PARTS -> assert(max_taken[q] + 1 >= taken[p]); q++
       :: else -> break
       od;
       q = 0;
       grant[AT(p, incarnation[p])] = grant[AT(p, incarnation[p])] & ~(BIT(taken[p]) - 1);   /* without effect from here on */
       max_taken[p] = (taken[p] > max_taken[p] -> taken[p] : max_taken[p]);
       answer[AT(p, incarnation[p])] = answer[AT(p, incarnation[p])] | BIT(taken[p]) }
  /* Receives the grant of its last turn again: sends the same answer again. */
  :: atomic { !over && taken[p] > 0 && (grant[AT(p, incarnation[p])] & BIT(taken[p])) &&
       !(answer[AT(p, incarnation[p])] & BIT(taken[p])) ->
       answer[AT(p, incarnation[p])] = answer[AT(p, incarnation[p])] | BIT(taken[p]) }
  /* Crashes, and is restarted with nothing. */
  :: atomic { !over && p < CRASHING && incarnation[p] < STARTS ->
       grant[AT(p, incarnation[p])] = 0;                             /* no receiver */
       incarnation[p]++;
       taken[p] = 0 }
  :: over -> break
  od
}

/* Loses datagrams to or from incarnation l of p. */
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
       incarnation[p] = 1;
       run participant(p);
       l = 1;
       do
       :: l <= STARTS -> run conductor_to(p, l); run network(p, l); l++
       :: else -> break
       od;
       p++
    :: else -> break
    od;
    run conductor()
  }
}
