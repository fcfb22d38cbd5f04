{REDUND_OK} FUNCTION Twice : REAL (*Twice the value*)
	VAR_INPUT
		value : REAL;
	END_VAR
END_FUNCTION

{REDUND_OK} FUNCTION_BLOCK Mean (*Mean of all values so far, twice*)
	VAR_INPUT
		value : REAL;
	END_VAR
	VAR_OUTPUT
		result : REAL;
		count : UINT;
	END_VAR
	VAR
		sum : REAL;
	END_VAR
END_FUNCTION_BLOCK
